//! Tests of rotation errors of more than a right angle: near 180° the part of gravity across the direction
//! found is small again.

use crate::common::messages;
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{Calibration, CalibrationSettings, ImuProblem, calibrate_imu};
use calibrant::sensor::{ImuParameters, ImuRecording, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{
    ImuSimulation, Purpose, TableAction, TableStep, simulate_imu, simulate_table, stream,
};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

fn calibrate(recording: &ImuRecording, model: SensorModel) -> Calibration {
    let (accelerometer, gyroscope) = (Sensor::triaxial(model), unfeeling_gyroscope());
    let problem =
        ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup: &steady_imu() };
    calibrate_imu(&problem, &CalibrationSettings::default()).expect("determined")
}

fn imu() -> ImuParameters {
    let mut imu = ImuParameters::identity();
    imu[SensorKind::Accelerometer].bias = Vector3::new(0.1, -0.05, 0.08);
    imu[SensorKind::Gyroscope].bias = Vector3::new(0.01, -0.02, 0.015);
    imu[SensorKind::Gyroscope].matrix =
        Matrix3::new(1.002, 0.003, -0.004, 0.002, 0.996, 0.005, -0.003, 0.001, 1.004);
    imu
}

/// Before one hold the gyroscope reports a rotation of the sensor that did not happen.
#[test]
fn a_rotation_that_ends_upside_down_is_left_out_with_its_angle() {
    let setup = ImuSimulation::default();
    let clean = simulate_imu(&imu(), &setup, &mut stream(1, Purpose::Sensor, 0));
    let calibration = calibrate(&clean, SensorModel::Full);
    assert!(calibration.rotations().iter().all(|rotation| rotation.used));
    for angle in [2.0, 2.5, PI] {
        let mut recording = clean.clone();
        let hold = calibration.hold_results()[7].hold.clone();
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
        // just before the hold that was found; across gravity; for a tenth of a second, as one sample is a
        // spike
        let at = hold.first - 3;
        let across = hold.mean.cross(&Vector3::x()).normalize();
        for reading in &mut gyroscope.readings_mut()[at - 9..=at] {
            *reading += across * (0.1 * angle * setup.rate_hz);
        }
        let found = calibrate(&recording, SensorModel::Full);
        let rotation = found
            .rotations()
            .iter()
            .find(|rotation| (rotation.start_s..rotation.end_s).contains(&gyroscope_time(&recording, at)))
            .expect("there");
        assert!(!rotation.used, "{angle}: {rotation:?}");
        let missed = rotation.error_rad;
        assert!((missed - angle).abs() < 0.03, "{angle}: missed by {missed}");
        assert_eq!(found.rotations().iter().filter(|rotation| !rotation.used).count(), 1);
        let (one, other) =
            (found.imu[SensorKind::Gyroscope].matrix, calibration.imu[SensorKind::Gyroscope].matrix);
        assert!((one - other).amax() < 3e-4, "{angle}: {}", one - other);
    }
}

fn gyroscope_time(recording: &ImuRecording, at: usize) -> f64 {
    recording[SensorKind::Gyroscope].as_ref().expect("there").times_s()[at]
}

/// About x only right angles, so that a rotation by −90° in place of 90° gives a rotation error of exactly
/// 180°.
#[test]
fn an_axis_that_points_the_other_way_is_found_where_all_turns_about_it_are_right_angles() {
    let up = |angles: &[f64], from: Vector3<f64>, to: Vector3<f64>| -> Vec<Vector3<f64>> {
        angles.iter().map(|angle: &f64| from * angle.cos() + to * angle.sin()).collect()
    };
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let quarter = PI / 2.0;
    let mut directions = up(&[0.0, quarter, 2.0 * quarter, 3.0 * quarter, 4.0 * quarter], z, y);
    directions.extend(up(&[0.7, 1.9, 2.8, 4.2, 5.1, 6.0, 7.2, 2.5 * PI], z, x));
    directions.extend(up(&[0.9, 1.6, 2.9, 3.7, 4.9, 6.1, 7.0], x, y));
    let steps: Vec<TableStep> = directions
        .iter()
        .enumerate()
        .map(|(k, direction)| {
            let start_s = 5.0 * k as f64;
            TableStep { start_s, end_s: start_s + 3.0, action: TableAction::Hold(*direction) }
        })
        .collect();
    let setup = ImuSimulation::default();
    let mut recording = simulate_table(&imu(), &steps, &setup, &mut stream(2, Purpose::Sensor, 0));
    let right = calibrate(&recording, SensorModel::ScaleBias);
    assert!((right.imu[SensorKind::Gyroscope].matrix[(0, 0)] - 1.002).abs() < 2e-3);
    recording[SensorKind::Gyroscope]
        .as_mut()
        .expect("there")
        .readings_mut()
        .iter_mut()
        .for_each(|reading| reading.x = -reading.x);
    let turned = calibrate(&recording, SensorModel::ScaleBias);
    let (one, other) = (turned.imu[SensorKind::Gyroscope].matrix, right.imu[SensorKind::Gyroscope].matrix);
    assert!(
        (one.row(0) + other.row(0)).amax() < 1e-6 && (one.row(1) - other.row(1)).amax() < 1e-6,
        "{one} {other}"
    );
    assert!(messages(&turned.warnings).iter().any(|warning| warning.contains("-x")), "{:?}", turned.warnings);
    assert!(turned.rotations().iter().all(|rotation| rotation.used));
}
