//! Tests of readings in steps coarser than their noise: more samples do not help, and a warning says so.

use crate::common::messages;
use crate::common::steady_imu;
use crate::common::{draw_imu, normal};
use calibrant::estimate::{
    Calibration, CalibrationSettings, CalibrationStatus, Gyroscope, ImuProblem, ImuSetup, Turn, calibrate_imu,
};
use calibrant::sensor::{ImuParameters, ImuRecording, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{
    ImuSimulation, Purpose, Rng, TableAction, TableStep, simulate_imu, simulate_table, stream,
};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// An IMU of the size of MEMS errors, with g-sensitivity.
fn draw(rng: &mut Rng) -> ImuParameters {
    ImuParameters { g_sensitivity: Matrix3::from_fn(|_, _| 2e-4 * normal(rng)), ..draw_imu(rng) }
}

/// Rounds the gyroscope's readings to multiples of a step.
fn round(recording: &mut ImuRecording, step: f64) {
    let readings = recording[SensorKind::Gyroscope].as_mut().expect("there").readings_mut();
    readings.iter_mut().for_each(|y| *y = y.map(|rate| (rate / step).round() * step));
}

fn run(recording: &ImuRecording, setup: &ImuSetup) -> calibrant::Result<Calibration> {
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

/// Six faces, and a turn there and back about each axis.
fn table() -> (Vec<TableStep>, ImuSetup) {
    let mut steps = Vec::new();
    let mut setup = ImuSetup { directions: Some(Vec::new()), face_sd_rad: Some(1e-6), ..steady_imu() };
    let mut intervals = Vec::new();
    for axis in 0..3 {
        let (up, from_s) = (Vector3::ith(axis, 1.0), 26.0 * axis as f64);
        let mut hold = |start_s: f64, direction: Vector3<f64>| {
            steps.push(TableStep { start_s, end_s: start_s + 5.0, action: TableAction::Hold(direction) });
            intervals.push((start_s, start_s + 5.0));
            setup.directions.as_mut().expect("there").push(direction);
        };
        hold(from_s, up);
        hold(from_s + 18.0, -up);
        for (start_s, sign) in [(from_s + 6.0, 1.0), (from_s + 11.0, -1.0)] {
            let (angle_rad, angle_sd_rad, end_s) =
                (sign * std::f64::consts::TAU, 0.1_f64.to_radians(), start_s + 4.0);
            let action = TableAction::Turn { axis: up, angle_rad, angle_sd_rad, axis_sd_rad: None };
            steps.push(TableStep { start_s, end_s, action });
            setup.turns.push(Turn {
                name: None,
                start_s,
                end_s,
                axis: up,
                angle_rad,
                angle_sd_rad,
                axis_sd_rad: None,
            });
        }
    }
    steps.sort_by(|one, other| one.start_s.total_cmp(&other.start_s));
    setup.holds.intervals_s = Some(intervals);
    (steps, setup)
}

/// Share of the gyroscope's 95 % intervals that cover the truth: of biases, of the matrix, of the g-sensitivity.
fn coverage(count: u64, step: f64, on_table: bool) -> [f64; 3] {
    let (steps, table) = table();
    let errors: Vec<Vec<f64>> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(31, Purpose::Sensor, number);
            let truth = draw(&mut rng);
            let simulation = ImuSimulation { rate_hz: 50.0, ..ImuSimulation::default() };
            let mut recording = match on_table {
                true => simulate_table(&truth, &steps, &simulation, &mut rng),
                false => simulate_imu(&truth, &simulation, &mut rng),
            };
            round(&mut recording, step);
            let setup = if on_table { table.clone() } else { steady_imu() };
            let calibration = run(&recording, &setup).expect("determined");
            assert_eq!(calibration.status, CalibrationStatus::Converged, "{number}");
            let pairs = calibration.quantities.iter().zip(calibration.values.iter().zip(calibration.sd()));
            let of_gyroscope = calibration.quantities.len() - 21..;
            let all: Vec<f64> = pairs.map(|(of, (value, sd))| (value - of.value(&truth)) / sd).collect();
            all[of_gyroscope].to_vec()
        })
        .collect();
    [0..3, 3..12, 12..21].map(|part| {
        let all = errors.iter().flat_map(|z| &z[part.clone()]);
        let inside = all.clone().filter(|z| z.abs() < 1.959_964).count();
        inside as f64 / all.count() as f64
    })
}

#[test]
fn intervals_are_not_too_narrow_where_the_gyroscope_is_coarse() {
    // noise 2e-3: half a step and more for the first, a fifth and a tenth for the others
    for on_table in [true, false] {
        for step in [1e-3, 0.005, 0.01, 0.02] {
            let covered = coverage(100, step, on_table);
            println!("table {on_table}, step {step}: {covered:.3?}");
            // errors of one recording are correlated: about 100 independent ones, of which 2.2 % is a
            // standard deviation
            assert!(covered.iter().all(|share| *share > 0.90), "table {on_table}, step {step}: {covered:?}");
            let usual = step > 0.003 || covered.iter().all(|share| *share < 0.98);
            assert!(usual, "a fine step widens nothing: {covered:?}");
        }
    }
}

#[test]
fn coarse_steps_are_named_with_the_noise_and_fine_ones_are_not() {
    let (steps, setup) = table();
    let mut rng = stream(32, Purpose::Sensor, 0);
    let simulation = ImuSimulation { rate_hz: 50.0, ..ImuSimulation::default() };
    let whole = simulate_table(&draw(&mut rng), &steps, &simulation, &mut rng);
    let message = |step: f64| {
        let mut recording = whole.clone();
        round(&mut recording, step);
        messages(&run(&recording, &setup).expect("determined").warnings).join("; ")
    };
    assert!(!message(1e-3).contains("come in steps"), "{}", message(1e-3));
    for (step, words) in [(0.01, "1.000e-2"), (0.02, "2.000e-2")] {
        for axis in ["x", "y", "z"] {
            let expected =
                format!("the readings of axis {axis} of the gyroscope come in steps of {words} rad/s");
            assert!(message(step).contains(&expected), "{}", message(step));
        }
        assert!(message(step).contains("however long the hold is"), "{}", message(step));
    }
    assert!(
        message(0.01).contains("the noise of about 2.") || message(0.01).contains("the noise of about 1."),
        "{}",
        message(0.01)
    );
}

#[test]
fn the_xsens_recording_is_not_coarse() {
    let Some((recording, _)) = crate::common::xsens() else { return };
    let holds = calibrant::estimate::find_imu_holds(&recording, 1.0).expect("found");
    let spans: Vec<_> = holds.iter().map(|hold| hold.first..hold.end).collect();
    for sensor in [recording[SensorKind::Accelerometer].clone(), recording[SensorKind::Gyroscope].clone()] {
        let sensor = sensor.expect("there");
        assert_eq!(sensor.resolution(), Vector3::repeat(1.0), "counts");
        assert_eq!(calibrant::estimate::coarse_axes(&sensor, &spans), []);
    }
}
