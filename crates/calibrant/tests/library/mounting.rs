//! Tests of the mounting: a gyroscope may be turned against the accelerometer by any angle.

use crate::common::messages;
use crate::common::{draw_imu, normal, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{Calibration, Gyroscope};
use calibrant::sensor::{ImuParameters, ImuRecording, ReadingUnit, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector4};

fn run(recording: &ImuRecording, unit: ReadingUnit) -> calibrant::Result<Calibration> {
    let gyroscope = Gyroscope { unit, ..unfeeling_gyroscope() };
    run_imu(recording, &gyroscope, &steady_imu(), ReadingUnit::MetrePerSecondSquared)
}

/// An IMU whose gyroscope's matrix has this factor.
fn turned(number: u64, by: &Matrix3<f64>) -> (ImuParameters, ImuRecording) {
    let mut rng = stream(501, Purpose::Sensor, number);
    let mut imu = draw_imu(&mut rng);
    imu[SensorKind::Gyroscope].matrix = by * imu[SensorKind::Gyroscope].matrix;
    let recording = simulate_imu(&imu, &ImuSimulation::default(), &mut rng);
    (imu, recording)
}

fn attitude(number: u64) -> Matrix3<f64> {
    let mut rng = stream(502, Purpose::Sensor, number);
    let quaternion = Unit::new_normalize(Vector4::from_fn(|_, _| normal(&mut rng)));
    UnitQuaternion::from_quaternion(quaternion.into_inner().into()).to_rotation_matrix().into_inner()
}

#[test]
fn every_attitude_is_found() {
    let about_z = |degrees: f64| Rotation3::from_euler_angles(0.0, 0.0, degrees.to_radians()).into_inner();
    let given = [10.0, 13.0, 16.0, 20.0, 30.0, 45.0].map(about_z);
    let drawn = (0..4).map(attitude).chain((4..6).map(|number| -attitude(number)));
    for (number, by) in (0..).zip(given.into_iter().chain(drawn)) {
        // in counts the gain is not known
        let unit = [ReadingUnit::RadianPerSecond, ReadingUnit::Counts][number as usize % 2];
        let gain = if unit == ReadingUnit::Counts { 1000.0 } else { 1.0 };
        let (truth, mut recording) = turned(number, &by);
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
        *gyroscope = gyroscope.mapped(unit, |reading| reading * gain);
        let calibration = run(&recording, unit).unwrap_or_else(|error| panic!("{number}: {error}"));
        let error = (calibration.imu[SensorKind::Gyroscope].matrix / gain
            - truth[SensorKind::Gyroscope].matrix)
            .amax();
        assert!(error < 5e-3, "{number}: {error}");
        let used = calibration.rotations().iter().filter(|rotation| rotation.used).count();
        assert!(used + 1 >= calibration.rotations().len(), "{number}: {used} rotations used");
    }
}

#[test]
fn the_angle_and_the_axis_are_told() {
    let (_, recording) = turned(3, &Rotation3::from_euler_angles(0.0, 0.0, 0.7).into_inner());
    let calibration = run(&recording, ReadingUnit::RadianPerSecond).expect("determined");
    let reported =
        "the gyroscope is mounted with a rotation of 40° against the accelerometer, about the axis (";
    assert!(
        messages(&calibration.warnings).iter().any(|message| message.contains(reported)),
        "{:#?}",
        calibration.warnings
    );
}

/// Rotations that have nothing to do with gravity fit no attitude.
#[test]
fn a_gyroscope_of_another_recording_is_refused_all_the_same() {
    for number in 0..8 {
        let (_, mut recording) = turned(number, &Matrix3::identity());
        recording[SensorKind::Gyroscope] =
            turned(number + 100, &Matrix3::identity()).1[SensorKind::Gyroscope].clone();
        let message = run(&recording, ReadingUnit::RadianPerSecond).expect_err("refused").to_string();
        assert!(message.contains("half of the rotations miss gravity"), "{message}");
    }
}
