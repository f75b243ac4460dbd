//! The Earth turns under the sensor: about the vertical, which looks like g-sensitivity, and about the north, in a heading that nobody knows.

mod common;

use calibrant::estimate::{
    CalibrationSettings, CovarianceVerdict, ErrorKind, Gyroscope, HoldsSetup, ImuCalibration, ImuProblem,
    ImuSetup, KnownTerm, Turn, calibrate_imu, cross_validate_imu,
};
use calibrant::motion::{EARTH_RATE_RADPS, earth_rate};
use calibrant::sensor::{ImuParameters, ImuQuantity, ImuRecording, Sensor, SensorModel};
use calibrant::simulate::{
    ImuSimulation, Purpose, TableAction, TableStep, simulate_imu, simulate_table, stream,
};
use common::draw_imu;
use nalgebra::{DVector, Matrix3, Vector3};
use rand::RngExt;
use rayon::prelude::*;

const GRAVITY: f64 = 9.806_65;
const SAID: &str = "the Earth turns about the vertical";

struct Bench {
    accelerometer: Sensor,
    gyroscope: Gyroscope,
    setup: ImuSetup,
}

impl Bench {
    fn new(g_sensitivity: bool, latitude_deg: Option<f64>) -> Self {
        Self {
            accelerometer: Sensor::triaxial(SensorModel::Full),
            gyroscope: Gyroscope { g_sensitivity, ..Gyroscope::default() },
            setup: ImuSetup { latitude_deg, holds: holds(), ..ImuSetup::default() },
        }
    }

    fn problem<'a>(&'a self, recording: &'a ImuRecording) -> ImuProblem<'a> {
        let Self { accelerometer, gyroscope, setup } = self;
        ImuProblem { accelerometer, gyroscope, recording, setup }
    }

    fn calibrate(&self, recording: &ImuRecording) -> ImuCalibration {
        calibrate_imu(&self.problem(recording), &CalibrationSettings::default()).expect("determined")
    }
}

/// Holds known to the sample, so that no gentle beginning of a turn falls into one: it would be more than the noise of a good gyroscope.
fn holds() -> HoldsSetup {
    let hold = |k: usize| (4.5 * k as f64 + 0.02, 4.5 * k as f64 + 2.46);
    HoldsSetup { intervals_s: Some((0..24).map(hold).collect()), ..HoldsSetup::default() }
}

/// A good gyroscope and accelerometer, turned by hand where the Earth turns so.
fn simulation(earth_rate_radps: Vector3<f64>) -> ImuSimulation {
    ImuSimulation {
        rate_hz: 50.0,
        accelerometer_noise: 5e-4,
        gyroscope_noise: 2e-5,
        earth_rate_radps,
        ..ImuSimulation::default()
    }
}

/// Nearly without noise, with the Earth turning about the vertical alone.
fn quiet(latitude_deg: f64) -> ImuSimulation {
    let vertical = Vector3::new(0.0, 0.0, earth_rate(latitude_deg).z);
    ImuSimulation { accelerometer_noise: 1e-6, gyroscope_noise: 1e-9, ..simulation(vertical) }
}

fn g_sensitivity(calibration: &ImuCalibration) -> Vec<usize> {
    let is = |k: &usize| matches!(calibration.quantities[*k], ImuQuantity::GSensitivity(..));
    (0..calibration.quantities.len()).filter(is).collect()
}

/// Mean square of the scores of the g-sensitivity over its entries and many sensors, the share of them within 1.96, mean of `eᵀ C⁻¹ e` over the number of entries, and in how many a word is said. `north`: does the Earth turn about the north, too?
fn scores(known: bool, north: bool) -> (f64, f64, f64, usize) {
    let count = 200_u64;
    let found: Vec<(Vec<f64>, f64, bool)> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(91, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            // anywhere on the Earth's sphere
            let latitude_deg = rng.random_range(-1.0_f64..1.0).asin().to_degrees();
            let mut rate = earth_rate(latitude_deg);
            rate.x *= f64::from(u8::from(north));
            let recording = simulate_imu(&truth, &simulation(rate), &mut rng);
            let calibration = Bench::new(true, known.then_some(latitude_deg)).calibrate(&recording);
            let places = g_sensitivity(&calibration);
            let error = |k: &usize| calibration.values[*k] - calibration.quantities[*k].of(&truth);
            let errors = DVector::from_iterator(9, places.iter().map(error));
            let covariance = calibration.covariance.select_rows(&places).select_columns(&places);
            let sd = calibration.sd();
            let z = places.iter().zip(errors.iter()).map(|(&k, error)| error / sd[k]).collect();
            let whole = errors.dot(&covariance.cholesky().expect("positive").solve(&errors)) / 9.0;
            (z, whole, calibration.warnings.iter().any(|warning| warning.contains(SAID)))
        })
        .collect();
    let z: Vec<f64> = found.iter().flat_map(|(z, ..)| z).copied().collect();
    let within = z.iter().filter(|z| z.abs() < 1.959_964).count() as f64 / z.len() as f64;
    (
        z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64,
        within,
        found.iter().map(|(_, whole, _)| whole).sum::<f64>() / count as f64,
        found.iter().filter(|(.., said)| *said).count(),
    )
}

#[test]
fn the_standard_deviations_of_the_g_sensitivity_are_right_wherever_on_the_earth() {
    for known in [true, false] {
        let (squares, within, whole, said) = scores(known, false);
        assert!((0.8..1.2).contains(&squares) && within > 0.94, "{known} {squares} {within}");
        assert!((0.8..1.2).contains(&whole) && said == if known { 0 } else { 200 }, "{known} {whole} {said}");
        // the rate about the north is one vector for all holds and rotations, and counts as scatter of each by itself
        let (squares, within, ..) = scores(known, true);
        assert!(squares < 1.8 && within > 0.86, "{known} {squares} {within}");
    }
}

#[test]
fn the_vertical_rate_is_in_the_model_and_without_a_latitude_it_is_the_g_sensitivity_of_the_closed_form() {
    for latitude_deg in [52.0, -33.9] {
        let mut rng = stream(92, Purpose::Sensor, 0);
        let truth = draw_imu(&mut rng);
        let recording = simulate_imu(&truth, &quiet(latitude_deg), &mut rng);
        let off = |calibration: &ImuCalibration| calibration.imu.g_sensitivity - truth.g_sensitivity;
        let bias = |calibration: &ImuCalibration| calibration.imu.gyroscope.bias - truth.gyroscope.bias;
        // what the rotations leave is of the integration of a linear rate
        let close =
            |calibration: &ImuCalibration| off(calibration).amax() < 2e-9 && bias(calibration).amax() < 2e-8;
        let mut bench = Bench::new(true, Some(latitude_deg));
        let calibration = bench.calibrate(&recording);
        assert!(close(&calibration), "{} {}", off(&calibration), bias(&calibration));
        assert!(calibration.still.rate_rms_radps < 1e-8, "{}", calibration.still.rate_rms_radps);
        // priors and fixed terms are of the g-sensitivity alone
        for sd in [Some(1e-9), None] {
            let term =
                |quantity: &ImuQuantity| KnownTerm { quantity: *quantity, value: quantity.of(&truth), sd };
            let places = g_sensitivity(&calibration);
            bench.setup.known = places.iter().map(|&k| term(&calibration.quantities[k])).collect();
            let known = bench.calibrate(&recording);
            assert!(close(&known), "{sd:?} {} {}", off(&known), bias(&known));
            assert!(!known.warnings.join("; ").contains("contradict"), "{:?}", known.warnings);
        }
        // without a latitude all of it goes into the g-sensitivity, and the covariance knows
        let unknown = Bench::new(true, None).calibrate(&recording);
        let expected = truth.gyroscope.matrix * (earth_rate(latitude_deg).z / GRAVITY);
        assert!((off(&unknown) - expected).amax() < 2e-9 && bias(&unknown).amax() < 2e-8);
        let (places, added) = (g_sensitivity(&unknown), &unknown.covariance - &calibration.covariance);
        let slope = |k: usize| match unknown.quantities[k] {
            ImuQuantity::GSensitivity(row, column) => truth.gyroscope.matrix[(row.index(), column.index())],
            _ => 0.0,
        };
        let scale = (EARTH_RATE_RADPS / GRAVITY).powi(2) / 3.0;
        for &i in &places {
            for &j in &places {
                let expected = slope(i) * slope(j) * scale;
                assert!((added[(i, j)] - expected).abs() < 1e-4 * scale, "{i} {j}: {}", added[(i, j)]);
            }
        }
    }
}

#[test]
fn without_g_sensitivity_the_vertical_rate_is_no_scatter_of_the_holds() {
    let mut rng = stream(93, Purpose::Sensor, 0);
    let truth = ImuParameters { g_sensitivity: Matrix3::zeros(), ..draw_imu(&mut rng) };
    let recording = simulate_imu(&truth, &quiet(-70.0), &mut rng);
    let [known, unknown] = [Some(-70.0), None].map(|at| Bench::new(false, at).calibrate(&recording));
    let bias = |calibration: &ImuCalibration| (calibration.imu.gyroscope.bias - truth.gyroscope.bias).amax();
    assert!(bias(&known) < 1e-7 && bias(&unknown) > 1e-6, "{:e} {:e}", bias(&known), bias(&unknown));
    // by the gain of the datasheet, which is off by a per cent
    let [known, unknown] = [known, unknown].map(|found| found.still.between_holds_sd.amax());
    assert!(known < 0.05 * EARTH_RATE_RADPS && unknown > 0.4 * EARTH_RATE_RADPS, "{known:e} {unknown:e}");
}

/// Holds on faces and whole turns with the axis up, as on a turntable.
fn table(latitude_deg: f64) -> (ImuParameters, ImuRecording, ImuSetup) {
    let (mut steps, mut setup, mut intervals, mut faces) =
        (Vec::new(), ImuSetup::default(), Vec::new(), Vec::new());
    let mut start_s = 0.0;
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let face = Vector3::ith(axis, sign);
            steps.push(TableStep { start_s, end_s: start_s + 5.0, action: TableAction::Hold(face) });
            intervals.push((start_s, start_s + 4.99));
            faces.push(face);
            if sign < 0.0 {
                let (from_s, end_s) = (start_s + 6.0, start_s + 16.0);
                let (axis, angle_rad, angle_sd_rad) = (face, std::f64::consts::TAU, 0.0);
                let action = TableAction::Turn { axis, angle_rad, angle_sd_rad };
                steps.push(TableStep { start_s: from_s, end_s, action });
                setup.turns.push(Turn {
                    name: None,
                    start_s: from_s,
                    end_s,
                    axis,
                    angle_rad,
                    angle_sd_rad: 1e-9,
                });
                start_s += 11.0;
            }
            start_s += 8.0;
        }
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(faces);
    let mut rng = stream(94, Purpose::Sensor, 0);
    let truth = ImuParameters { g_sensitivity: Matrix3::zeros(), ..draw_imu(&mut rng) };
    let recording = simulate_table(&truth, &steps, &quiet(latitude_deg), &mut rng);
    (truth, recording, setup)
}

#[test]
fn a_turn_on_a_table_is_that_of_the_sensor_and_the_earth() {
    let (truth, recording, setup) = table(60.0);
    for (latitude_deg, missed) in
        [(Some(60.0), 0.0), (None, earth_rate(60.0).z * 10.0 / std::f64::consts::TAU)]
    {
        let bench = Bench { setup: ImuSetup { latitude_deg, ..setup.clone() }, ..Bench::new(false, None) };
        let calibration = bench.calibrate(&recording);
        let off = calibration.imu.gyroscope.matrix - truth.gyroscope.matrix;
        for axis in 0..3 {
            let share = off[(axis, axis)] / truth.gyroscope.matrix[(axis, axis)];
            assert!((share - missed).abs() < 2e-6 + 0.03 * missed, "{latitude_deg:?} {axis}: {share:e}");
        }
    }
}

#[test]
fn errors_of_unused_holds_know_of_it() {
    let count = 12_u64;
    let verdicts: Vec<[CovarianceVerdict; 2]> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(95, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            let recording = simulate_imu(&truth, &simulation(earth_rate(45.0)), &mut rng);
            [Some(45.0), None].map(|latitude_deg| {
                let bench = Bench::new(true, latitude_deg);
                let calibration = bench.calibrate(&recording);
                let settings = CalibrationSettings::default();
                let folds = cross_validate_imu(&calibration, &bench.problem(&recording), &settings, 5);
                folds.expect("determined").of_kind(ErrorKind::Rate).expect("holds").verdict
            })
        })
        .collect();
    for known in 0..2 {
        let believed = verdicts.iter().filter(|of| of[known] == CovarianceVerdict::Believed).count();
        assert!(believed >= 11, "{known}: {verdicts:?}");
    }
    // without noise nothing is left of the rate about the vertical
    let mut rng = stream(95, Purpose::Sensor, 99);
    let recording = simulate_imu(&draw_imu(&mut rng), &quiet(45.0), &mut rng);
    let bench = Bench::new(true, Some(45.0));
    let calibration = bench.calibrate(&recording);
    let settings = CalibrationSettings::default();
    let folds = cross_validate_imu(&calibration, &bench.problem(&recording), &settings, 5);
    let rms = folds.expect("determined").of_kind(ErrorKind::Rate).expect("holds").rms;
    assert!(rms < 1e-7, "{rms:e}");
}
