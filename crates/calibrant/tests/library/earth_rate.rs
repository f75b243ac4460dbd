//! Tests of Earth's rate under the sensor. About the vertical it looks like g-sensitivity; about the north
//! its heading is unknown.

use crate::common::{draw_imu, messages};
use crate::common::{steady_holds, steady_imu};
use calibrant::estimate::{
    Calibration, CalibrationSettings, CovarianceVerdict, ErrorKind, Gyroscope, HoldsSetup, ImuProblem,
    ImuSetup, KnownTerm, Turn, calibrate_imu, cross_validate_imu,
};
use calibrant::motion::{EARTH_RATE_RADPS, earth_rate};
use calibrant::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, Quantity, Sensor, SensorKind, SensorModel,
};
use calibrant::simulate::{
    ImuSimulation, Purpose, TableAction, TableStep, simulate_imu, simulate_table, stream,
};
use nalgebra::{DVector, Matrix3, Vector3};
use rand::RngExt;
use rayon::prelude::*;

/// Gravity of the simulations, m/s².
const GRAVITY: f64 = 9.806_65;

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
            setup: ImuSetup { latitude_deg, holds: holds(), ..steady_imu() },
        }
    }

    fn problem<'a>(&'a self, recording: &'a ImuRecording) -> ImuProblem<'a> {
        let Self { accelerometer, gyroscope, setup } = self;
        ImuProblem { accelerometer, gyroscope, recording, setup }
    }

    fn calibrate(&self, recording: &ImuRecording) -> Calibration {
        calibrate_imu(&self.problem(recording), &CalibrationSettings::default()).expect("determined")
    }
}

/// Holds known to the sample, so that no slow start of a turn falls into one. It would be more than the noise
/// of a good gyroscope.
fn holds() -> HoldsSetup {
    let hold = |k: usize| (4.5 * k as f64 + 0.02, 4.5 * k as f64 + 2.46);
    HoldsSetup { intervals_s: Some((0..24).map(hold).collect()), ..steady_holds() }
}

/// A good gyroscope and accelerometer, turned by hand under this Earth's rate.
fn simulation(earth_rate_radps: Vector3<f64>) -> ImuSimulation {
    ImuSimulation {
        rate_hz: 50.0,
        accelerometer_noise: 5e-4,
        gyroscope_noise: 2e-5,
        earth_rate_radps,
        ..ImuSimulation::default()
    }
}

/// Nearly without noise, with Earth's rate about the vertical alone.
fn quiet(latitude_deg: f64) -> ImuSimulation {
    let vertical = Vector3::new(0.0, 0.0, earth_rate(latitude_deg).z);
    ImuSimulation { accelerometer_noise: 1e-6, gyroscope_noise: 1e-9, ..simulation(vertical) }
}

/// The same with the rate about the north.
fn quiet_world(latitude_deg: f64) -> ImuSimulation {
    ImuSimulation { earth_rate_radps: earth_rate(latitude_deg), ..quiet(latitude_deg) }
}

fn g_sensitivity(calibration: &Calibration) -> Vec<usize> {
    let is = |k: &usize| matches!(calibration.quantities[*k], ImuQuantity::GSensitivity(..));
    (0..calibration.quantities.len()).filter(is).collect()
}

/// Errors of sensors in standard deviations.
struct Scores {
    /// Scores of the g-sensitivity's entries.
    g_sensitivity: Vec<f64>,
    /// Scores of the gyroscope's biases and matrix.
    others: Vec<f64>,
    /// Mean of `eᵀ C⁻¹ e` of the g-sensitivity over the number of its entries.
    whole: f64,
    /// Mean standard deviation of the g-sensitivity, (rad/s)/(m/s²).
    sd: f64,
    /// Number of calibrations that an unknown latitude makes less certain.
    less_certain: usize,
}

/// Mean square, and the share within 1.96.
fn squares_within(z: &[f64]) -> (f64, f64) {
    let count = z.len() as f64;
    let within = z.iter().filter(|z| z.abs() < 1.959_964).count() as f64;
    (z.iter().map(|z| z * z).sum::<f64>() / count, within / count)
}

/// A rate so high that the change of rates between samples is less than their noise.
const RATE_HZ: f64 = 200.0;

fn scores(known: bool) -> Scores {
    let count = 100_u64;
    let found: Vec<Scores> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(91, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            // anywhere on the Earth's sphere
            let latitude_deg = rng.random_range(-1.0_f64..1.0).asin().to_degrees();
            let world = ImuSimulation { rate_hz: RATE_HZ, ..simulation(earth_rate(latitude_deg)) };
            let recording = simulate_imu(&truth, &world, &mut rng);
            let calibration = Bench::new(true, known.then_some(latitude_deg)).calibrate(&recording);
            let places = g_sensitivity(&calibration);
            let error = |k: &usize| calibration.values[*k] - calibration.quantities[*k].value(&truth);
            let errors = DVector::from_iterator(9, places.iter().map(error));
            let covariance = calibration.covariance.select_rows(&places).select_columns(&places);
            let sd = calibration.sd();
            let score = |k: &usize| error(k) / sd[*k];
            let others = (0..sd.len()).filter(|&k| match calibration.quantities[k] {
                ImuQuantity::Of(sensor_kind, _) => sensor_kind == SensorKind::Gyroscope,
                _ => false,
            });
            let whole = errors.dot(&covariance.cholesky().expect("positive").solve(&errors)) / 9.0;
            let mean_sd = places.iter().map(|&k| sd[k]).sum::<f64>() / 9.0;
            let less_certain = calibration.unknown_latitude().is_some();
            Scores {
                g_sensitivity: places.iter().map(score).collect(),
                others: others.map(|k| score(&k)).collect(),
                whole,
                sd: mean_sd,
                less_certain: usize::from(less_certain),
            }
        })
        .collect();
    let mean = |of: fn(&Scores) -> f64| found.iter().map(of).sum::<f64>() / count as f64;
    Scores {
        g_sensitivity: found.iter().flat_map(|found| found.g_sensitivity.clone()).collect(),
        others: found.iter().flat_map(|found| found.others.clone()).collect(),
        whole: mean(|found| found.whole),
        sd: mean(|found| found.sd),
        less_certain: found.iter().map(|found| found.less_certain).sum(),
    }
}

#[test]
fn the_standard_deviations_of_the_gyroscope_are_right_wherever_on_the_earth() {
    for known in [true, false] {
        let scores = scores(known);
        let (squares, within) = squares_within(&scores.g_sensitivity);
        assert!((0.8..1.2).contains(&squares) && within > 0.94, "{known} {squares} {within}");
        let (whole, less_certain) = (scores.whole, scores.less_certain);
        assert!(
            (0.8..1.2).contains(&whole) && less_certain == if known { 0 } else { 100 },
            "{known} {whole} {less_certain}"
        );
        let (squares, within) = squares_within(&scores.others);
        assert!((0.8..1.2).contains(&squares) && within > 0.92, "{known} {squares} {within}");
        // as scatter of the holds, the rate about the north made this 1.5e-6
        assert!(!known || scores.sd < 2e-7, "{}", scores.sd);
    }
}

#[test]
fn the_vertical_rate_is_in_the_model_and_without_a_latitude_it_is_the_g_sensitivity_of_the_closed_form() {
    for latitude_deg in [52.0, -33.9] {
        let mut rng = stream(92, Purpose::Sensor, 0);
        let truth = draw_imu(&mut rng);
        let recording = simulate_imu(&truth, &quiet_world(latitude_deg), &mut rng);
        let off = |calibration: &Calibration| calibration.imu.g_sensitivity - truth.g_sensitivity;
        let bias = |calibration: &Calibration| {
            calibration.imu[SensorKind::Gyroscope].bias - truth[SensorKind::Gyroscope].bias
        };
        // the rotations leave an error of the integration of a linear rate
        let close =
            |calibration: &Calibration| off(calibration).amax() < 2e-9 && bias(calibration).amax() < 2e-8;
        let mut bench = Bench::new(true, Some(latitude_deg));
        let calibration = bench.calibrate(&recording);
        assert!(close(&calibration), "{} {}", off(&calibration), bias(&calibration));
        // the rate about the north remains
        let north = earth_rate(latitude_deg).x.abs();
        let rms = calibration.gyroscope.as_ref().expect("an IMU").still.rate_rms_radps;
        assert!((rms - north).abs() < 1e-8, "{rms:e} {north:e}");
        // priors and fixed terms are of the g-sensitivity alone
        for sd in [Some(1e-9), None] {
            let term =
                |quantity: &ImuQuantity| KnownTerm { quantity: *quantity, value: quantity.value(&truth), sd };
            let places = g_sensitivity(&calibration);
            bench.setup.known = places.iter().map(|&k| term(&calibration.quantities[k])).collect();
            let known = bench.calibrate(&recording);
            assert!(close(&known), "{sd:?} {} {}", off(&known), bias(&known));
            assert!(!messages(&known.warnings).join("; ").contains("contradict"), "{:?}", known.warnings);
        }
        // without a latitude all of it goes into the g-sensitivity, and the covariance contains that
        let unknown = Bench::new(true, None).calibrate(&recording);
        let expected = truth[SensorKind::Gyroscope].matrix * (earth_rate(latitude_deg).z / GRAVITY);
        assert!((off(&unknown) - expected).amax() < 2e-9 && bias(&unknown).amax() < 2e-8);
        let (places, added) = (g_sensitivity(&unknown), &unknown.covariance - &calibration.covariance);
        let slope = |k: usize| match unknown.quantities[k] {
            ImuQuantity::GSensitivity(row, column) => {
                truth[SensorKind::Gyroscope].matrix[(row.index(), column.index())]
            }
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
fn without_g_sensitivity_the_holds_tell_the_vertical_rate() {
    let mut rng = stream(93, Purpose::Sensor, 0);
    let truth = ImuParameters { g_sensitivity: Matrix3::zeros(), ..draw_imu(&mut rng) };
    let recording = simulate_imu(&truth, &quiet_world(-70.0), &mut rng);
    let [known, unknown] = [Some(-70.0), None].map(|at| Bench::new(false, at).calibrate(&recording));
    let bias = |calibration: &Calibration| {
        (calibration.imu[SensorKind::Gyroscope].bias - truth[SensorKind::Gyroscope].bias).amax()
    };
    assert!(bias(&known) < 2e-8 && bias(&unknown) < 2e-8, "{:e} {:e}", bias(&known), bias(&unknown));
    // what is not given counts as scatter in another recording
    let scatter = |calibration: &Calibration| {
        calibration.gyroscope.as_ref().expect("an IMU").still.between_holds_sd.norm()
    };
    let rate = earth_rate(-70.0);
    let (known, unknown) = (scatter(&known) / rate.x.abs(), scatter(&unknown) / rate.norm());
    assert!((known - 1.0).abs() < 0.02 && (unknown - 1.0).abs() < 0.02, "{known} {unknown}");
}

#[test]
fn where_a_rotation_cannot_be_followed_another_heading_begins() {
    let mut rng = stream(96, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let mut recording = simulate_imu(&truth, &quiet_world(34.0), &mut rng);
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("a gyroscope");
    // the gyroscope pauses in the third, the fourth and the tenth rotation, so that a hold is alone
    let paused = |t: f64| [3, 4, 10].iter().any(|&k| (t - 4.5 * f64::from(k) + 1.0).abs() < 0.4);
    *gyroscope = gyroscope.only(|k| !paused(gyroscope.times_s()[k]));
    let calibration = Bench::new(true, Some(34.0)).calibrate(&recording);
    assert_eq!(calibration.rotations().iter().filter(|rotation| !rotation.used).count(), 3);
    let off = (calibration.imu.g_sensitivity - truth.g_sensitivity).amax();
    let bias = (calibration.imu[SensorKind::Gyroscope].bias - truth[SensorKind::Gyroscope].bias).amax();
    assert!(off < 2e-9 && bias < 2e-8, "{off:e} {bias:e}");
}

/// Holds on faces and whole turns with the axis up, as on a turntable.
fn table(number: u64, simulation: &ImuSimulation) -> (ImuParameters, ImuRecording, ImuSetup) {
    let (mut steps, mut setup, mut intervals, mut faces) = (Vec::new(), steady_imu(), Vec::new(), Vec::new());
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
                let action = TableAction::Turn { axis, angle_rad, angle_sd_rad, axis_sd_rad: None };
                steps.push(TableStep { start_s: from_s, end_s, action });
                setup.turns.push(Turn {
                    name: None,
                    start_s: from_s,
                    end_s,
                    axis,
                    angle_rad,
                    angle_sd_rad: 1e-9,
                    axis_sd_rad: None,
                });
                start_s += 11.0;
            }
            start_s += 8.0;
        }
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(faces);
    // as the faces of the simulation
    setup.face_sd_rad = Some(1e-6);
    let mut rng = stream(94, Purpose::Sensor, number);
    let truth = ImuParameters { g_sensitivity: Matrix3::zeros(), ..draw_imu(&mut rng) };
    let recording = simulate_table(&truth, &steps, simulation, &mut rng);
    (truth, recording, setup)
}

#[test]
fn a_turn_on_a_table_is_that_of_the_sensor_and_the_earth() {
    let (truth, recording, setup) = table(0, &quiet(60.0));
    // without a latitude the holds on faces determine the rate
    for latitude_deg in [Some(60.0), None] {
        let bench = Bench { setup: ImuSetup { latitude_deg, ..setup.clone() }, ..Bench::new(false, None) };
        let calibration = bench.calibrate(&recording);
        let off = calibration.imu[SensorKind::Gyroscope].matrix - truth[SensorKind::Gyroscope].matrix;
        for axis in 0..3 {
            let share = off[(axis, axis)] / truth[SensorKind::Gyroscope].matrix[(axis, axis)];
            assert!(share.abs() < 2e-6, "{latitude_deg:?} {axis}: {share:e}");
        }
    }
}

#[test]
fn the_gains_of_a_table_at_an_unknown_latitude_are_as_uncertain_as_they_say() {
    let count = 150_u64;
    let z: Vec<Vec<f64>> = (0..count)
        .into_par_iter()
        .map(|number| {
            let sine = stream(97, Purpose::Sensor, number).random_range(-1.0_f64..1.0);
            let noise = 10.0_f64.powf(-5.0 + (number % 3) as f64);
            // the rate about the north has another direction on each face, and is scatter of the faces
            let vertical = Vector3::new(0.0, 0.0, EARTH_RATE_RADPS * sine);
            let world = ImuSimulation { gyroscope_noise: noise, ..simulation(vertical) };
            let (truth, recording, setup) = table(number, &world);
            let calibration = Bench { setup, ..Bench::new(false, None) }.calibrate(&recording);
            let sd = calibration.sd();
            let score = |k: usize| (calibration.values[k] - calibration.quantities[k].value(&truth)) / sd[k];
            let is_gain = |k: &usize| {
                matches!(
                    calibration.quantities[*k],
                    ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(_))
                )
            };
            (0..sd.len()).filter(is_gain).map(score).collect()
        })
        .collect();
    for noise in 0..3 {
        let z: Vec<f64> = z.iter().skip(noise).step_by(3).flatten().copied().collect();
        let (squares, within) = squares_within(&z);
        assert!((0.6..1.5).contains(&squares) && within > 0.9, "{noise}: {squares} {within}");
    }
}

#[test]
fn errors_of_unused_holds_know_of_it() {
    let count = 12_u64;
    let kinds = [ErrorKind::Rate, ErrorKind::Rotation];
    let verdicts: Vec<[[CovarianceVerdict; 2]; 2]> = (0..count)
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
                let folds = folds.expect("determined");
                kinds.map(|kind| folds.of_kind(kind).expect("tried").verdict)
            })
        })
        .collect();
    for known in 0..2 {
        for kind in 0..2 {
            let believed = |of: &&[[CovarianceVerdict; 2]; 2]| of[known][kind] == CovarianceVerdict::Believed;
            let believed = verdicts.iter().filter(believed).count();
            assert!(believed >= 11, "{known} {kind}: {verdicts:?}");
        }
    }
    // without noise nothing remains of the rate about the vertical
    let mut rng = stream(95, Purpose::Sensor, 99);
    let recording = simulate_imu(&draw_imu(&mut rng), &quiet(45.0), &mut rng);
    let bench = Bench::new(true, Some(45.0));
    let calibration = bench.calibrate(&recording);
    let settings = CalibrationSettings::default();
    let folds = cross_validate_imu(&calibration, &bench.problem(&recording), &settings, 5);
    let rms = folds.expect("determined").of_kind(ErrorKind::Rate).expect("holds").rms;
    assert!(rms < 1e-7, "{rms:e}");
}
