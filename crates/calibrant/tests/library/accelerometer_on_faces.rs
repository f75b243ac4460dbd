//! An accelerometer alone in known directions: its matrix in their frame, with honest intervals; wrong directions are refused.

use crate::common::normal;
use crate::common::steady_holds;
use calibrant::Error;
use calibrant::error::Refusal;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, FacesProblem, HoldsSetup, Stimulus, TiltSource,
    calibrate, calibrate_faces,
};
use calibrant::sensor::{ImuParameters, Recording, Sensor, SensorKind, SensorModel, SensorParameters};
use calibrant::simulate::{ImuSimulation, Purpose, Rng, TableAction, TableStep, simulate_table, stream};
use nalgebra::{Matrix3, Rotation3, Vector3};
use rayon::prelude::*;

fn faces() -> Vec<Vector3<f64>> {
    (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| Vector3::ith(axis, sign))).collect()
}

/// The faces twice, and poses of an arm between them.
fn poses() -> Vec<Vector3<f64>> {
    let oblique = [[0.6, 0.0, 0.8], [0.0, -0.6, 0.8], [-0.8, 0.6, 0.0], [0.6, 0.6, -0.529_150_262_212_918]];
    [faces(), oblique.map(Vector3::from).to_vec(), faces()].concat()
}

/// A sensor with twelve errors, turned in its fixture by about `turn_rad`.
fn draw(turn_rad: f64, rng: &mut Rng) -> SensorParameters {
    let errors = Matrix3::from_fn(|_, _| 0.01 * normal(rng));
    let turn = Rotation3::from_scaled_axis(Vector3::from_fn(|_, _| turn_rad * normal(rng)));
    SensorParameters {
        bias: Vector3::from_fn(|_, _| 0.1 * normal(rng)),
        matrix: (Matrix3::identity() + errors) * turn.matrix(),
        ..SensorParameters::identity()
    }
}

fn record(
    truth: &SensorParameters,
    directions: &[Vector3<f64>],
    tilt_rad: f64,
    rng: &mut Rng,
) -> (Recording, HoldsSetup) {
    let start_s = |k: usize| 6.0 * k as f64;
    let step = |(k, direction): (usize, &Vector3<f64>)| {
        let action = TableAction::Hold(*direction);
        TableStep { start_s: start_s(k), end_s: start_s(k) + 4.0, action }
    };
    let steps: Vec<TableStep> = directions.iter().enumerate().map(step).collect();
    let simulation = ImuSimulation { face_sd_rad: tilt_rad, rate_hz: 50.0, ..ImuSimulation::default() };
    let imu = ImuParameters::identity().with(SensorKind::Accelerometer, *truth);
    let recording =
        simulate_table(&imu, &steps, &simulation, rng)[SensorKind::Accelerometer].clone().expect("recorded");
    let intervals_s = Some((0..steps.len()).map(|k| (start_s(k), start_s(k) + 3.99)).collect());
    (recording, HoldsSetup { intervals_s, ..steady_holds() })
}

fn run(
    (recording, holds): &(Recording, HoldsSetup),
    directions: &[Vector3<f64>],
    face_sd_rad: Option<f64>,
) -> calibrant::Result<Calibration> {
    let sensor = &Sensor::triaxial(SensorModel::Full);
    let problem = FacesProblem { sensor, recording, holds, directions, face_sd_rad };
    calibrate_faces(&problem, &CalibrationSettings::default())
}

/// Share of the 95 % intervals of biases, scale factors and cross-axis terms that cover the truth, and the mean square of z.
fn coverage(number: u64, directions: &[Vector3<f64>], tilt_deg: f64, given: bool) -> [(f64, f64); 3] {
    let tilt_rad = tilt_deg.to_radians();
    let all: Vec<Vec<f64>> = (0..400)
        .into_par_iter()
        .map(|sensor| {
            let mut rng = stream(number, Purpose::Sensor, sensor);
            let truth = draw(tilt_rad, &mut rng);
            let recorded = record(&truth, directions, tilt_rad, &mut rng);
            let found = run(&recorded, directions, given.then_some(tilt_rad)).expect("determined");
            let imu = ImuParameters::identity().with(SensorKind::Accelerometer, truth);
            let of_truth = found.quantities.iter().map(|quantity| quantity.value(&imu));
            let values = found.values.iter().zip(found.sd()).zip(of_truth);
            values.map(|((value, sd), truth)| (value - truth) / sd).collect()
        })
        .collect();
    [0..3, 3..6, 6..12].map(|places| {
        let z: Vec<f64> = all.iter().flat_map(|of| of[places.clone()].to_vec()).collect();
        let covered = z.iter().filter(|z| z.abs() < 1.959_964).count() as f64 / z.len() as f64;
        (covered, z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64)
    })
}

#[test]
fn intervals_of_twelve_parameters_cover_the_truth() {
    let mut off = Vec::new();
    let cases = [(0.1, true), (1.0, true), (0.1, false), (1.0, false)];
    for (number, (tilt_deg, given)) in (301..).zip(cases) {
        for (name, directions) in [("faces", faces()), ("poses", poses())] {
            let kinds = ["bias", "scale", "cross"];
            for (kind, (covered, square)) in kinds.iter().zip(coverage(number, &directions, tilt_deg, given))
            {
                let line = format!(
                    "{name}, {tilt_deg}°, given {given}, {kind}: {covered:.3} covered, z² {square:.2}"
                );
                println!("{line}");
                // of 1200 at least, 0.6 % is a standard deviation. The scatter of few faces is uncertain, and where tilts decide, what the
                // magnitudes tell has too wide intervals (`known_faces`)
                // and what opposite directions may share is in the matrix, and is not drawn here
                let most = if *kind == "bias" { 0.998 } else { 1.0 };
                if !(0.93..=most).contains(&covered) {
                    off.push(line);
                }
            }
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

/// What a box is off square, it is at each placement: holding its faces again makes the biases no better, and bends no response.
#[test]
fn a_box_off_square_is_off_at_each_placement() {
    let tilt_rad = 0.5_f64.to_radians();
    let nominal: Vec<Vector3<f64>> = std::iter::repeat_with(faces).take(4).flatten().collect();
    for given in [Some(tilt_rad), None] {
        let of = |sensor: u64| -> Vec<f64> {
            let mut rng = stream(313, Purpose::Sensor, sensor);
            let truth = draw(0.0, &mut rng);
            let mut tilt =
                || Rotation3::from_scaled_axis(Vector3::from_fn(|_, _| tilt_rad * normal(&mut rng)));
            let off: Vec<Vector3<f64>> = faces().iter().map(|face| tilt() * face).collect();
            let met: Vec<Vector3<f64>> = std::iter::repeat_n(off, 4).flatten().collect();
            let recorded = record(&truth, &met, 0.05 * tilt_rad, &mut rng);
            let found = run(&recorded, &nominal, given).expect("determined");
            assert!(found.warnings.is_empty(), "{:?}", found.warnings);
            let off = found.imu[SensorKind::Accelerometer].bias - truth.bias;
            off.iter().zip(found.sd()).map(|(off, sd)| off / sd).collect()
        };
        let z: Vec<f64> = (0..120).into_par_iter().flat_map_iter(of).collect();
        let covered = z.iter().filter(|z| z.abs() < 1.959_964).count() as f64 / z.len() as f64;
        // of 360: 1.1 % is a standard deviation
        assert!((0.92..=0.98).contains(&covered), "{given:?}: {covered}");
    }
}

#[test]
fn directions_fix_the_frame_and_their_errors_count() {
    let mut rng = stream(311, Purpose::Sensor, 0);
    let truth = draw(0.02, &mut rng);
    let recorded = record(&truth, &poses(), 2e-3, &mut rng);
    let found = run(&recorded, &poses(), Some(2e-3)).expect("determined");
    assert!(found.frame_is_known() && found.quantities.len() == 12);
    assert_eq!(found.holds().and_then(|holds| holds.tilt).expect("faces").source, TiltSource::Given);
    assert!((found.imu[SensorKind::Accelerometer].matrix - truth.matrix).amax() < 4e-3);
    // twice the alignment, twice the standard deviation of the cross-axis terms; more where poses that are held again do not show it
    let doubled = run(&recorded, &poses(), Some(4e-3)).expect("determined");
    let cross = |of: &Calibration| -> f64 { of.sd()[6..].iter().sum() };
    let by = cross(&doubled) / cross(&found);
    assert!((1.95..2.3).contains(&by), "{by}");
    // without directions, the frame is that of a gauge
    let (sensor, stimulus) = (&Sensor::triaxial(SensorModel::Full), Stimulus::Holds(&recorded.1));
    let problem = CalibrationProblem { sensor, recording: &recorded.0, stimulus };
    let free = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
    assert!((free.imu[SensorKind::Accelerometer].matrix - truth.matrix).amax() > 0.01);
}

#[test]
fn wrong_directions_are_refused() {
    let mut rng = stream(312, Purpose::Sensor, 0);
    let recorded = record(&draw(0.01, &mut rng), &poses(), 2e-3, &mut rng);
    let any = |_| Vector3::from_fn(|_, _| normal(&mut rng));
    let nonsense: Vec<Vector3<f64>> = (0..poses().len()).map(any).collect();
    let mut flipped = poses();
    flipped[3] = -flipped[3];
    let all_down: Vec<Vector3<f64>> = poses().iter().map(|direction| -direction).collect();
    for (name, wrong) in [("nonsense", nonsense), ("one flipped", flipped), ("all down", all_down)] {
        for given in [None, Some(2e-3)] {
            match run(&recorded, &wrong, given) {
                Err(Error::Experiment(input_error)) => {
                    assert_eq!(input_error.code, Refusal::FacesContradicted, "{name}: {input_error}");
                }
                other => panic!("{name} {given:?}: {other:?}"),
            }
        }
    }
    let few = run(&recorded, &poses()[..3], None).expect_err("one for each hold").to_string();
    assert!(few.contains("16 holds are given, and 3 directions"), "{few}");
}
