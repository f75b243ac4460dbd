//! Simulated and recorded IMUs that several tests share.

use calibrant::estimate::{
    Calibration, CalibrationSettings, Gyroscope, HoldsSetup, ImuProblem, ImuSetup, calibrate_imu,
};
use calibrant::io::{ImuReadOptions, ImuUnit, read_imu_pair, read_imu_recording};
use calibrant::motion::Gravity;
use calibrant::sensor::{
    Gauge, ImuParameters, ImuRecording, ReadingUnit, Recording, Sensor, SensorKind, SensorModel,
    SensorParameters, Thermal,
};
use calibrant::simulate::Rng;
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};
use std::path::Path;

/// The recording of imu_tk in counts, with gravity at its place; `None` where the file is absent.
pub(crate) fn xsens() -> Option<(ImuRecording, Gravity)> {
    let accelerometer = super::shared_data("xsens-mti-static/xsens_acc.mat")?;
    let gyroscope = super::shared_data("xsens-mti-static/xsens_gyro.mat")?;
    let options = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::Counts),
        gyroscope_unit: Some(ImuUnit::Counts),
        ..ImuReadOptions::default()
    };
    let recording = read_imu_pair(&accelerometer, &gyroscope, &options).expect("readable").recording;
    Some((recording, Gravity { magnitude_mps2: 9.81744, sd_mps2: 0.0 }))
}

pub(crate) fn normal(rng: &mut Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// An IMU of the size of MEMS errors, its accelerometer in the upper gauge, without g-sensitivity.
pub(crate) fn draw_imu(rng: &mut Rng) -> ImuParameters {
    let mut sensor = |bias: f64, spread: f64| SensorParameters {
        bias: Vector3::from_fn(|_, _| bias * normal(rng)),
        matrix: Matrix3::identity() + Matrix3::from_fn(|_, _| spread * normal(rng)),
        ..SensorParameters::identity()
    };
    let accelerometer = Gauge::Upper.apply(&sensor(0.1, 0.01));
    let gyroscope = sensor(0.02, 0.01);
    ImuParameters {
        sensors: [accelerometer, gyroscope].into(),
        g_sensitivity: Matrix3::zeros(),
        thermal: Thermal::none(),
    }
}

/// An IMU of the size of MEMS errors, with g-sensitivity.
pub(crate) fn draw_feeling_imu(rng: &mut Rng) -> ImuParameters {
    let imu = draw_imu(rng);
    ImuParameters { g_sensitivity: Matrix3::from_fn(|_, _| 2e-4 * normal(rng)), ..imu }
}

/// A gyroscope whose g-sensitivity is not estimated.
pub(crate) fn unfeeling_gyroscope() -> Gyroscope {
    Gyroscope { g_sensitivity: false, ..Gyroscope::default() }
}

/// Holds of a sensor whose biases do not drift, under known gravity, in the upper gauge.
pub(crate) fn steady_holds() -> HoldsSetup {
    let gravity = Gravity { magnitude_mps2: 9.806_65, sd_mps2: 0.0 };
    HoldsSetup { gravity, bias_drift_sd_mps2: 0.0, gauge: Gauge::Upper, ..HoldsSetup::default() }
}

/// A recording of an IMU whose biases do not drift, in the upper gauge.
pub(crate) fn steady_imu() -> ImuSetup {
    ImuSetup { holds: steady_holds(), ..ImuSetup::default() }
}

/// A triaxial accelerometer with cross-axis terms. In counts, its gain is not known.
fn accelerometer(unit: ReadingUnit) -> Sensor {
    let sensor = Sensor::triaxial(SensorModel::Full);
    match unit {
        ReadingUnit::Counts => Sensor { unit, gain: None, offset: None, ..sensor },
        _ => sensor,
    }
}

/// Calibrates an IMU from holds and rotations.
pub(crate) fn run_imu(
    recording: &ImuRecording,
    gyroscope: &Gyroscope,
    setup: &ImuSetup,
    unit: ReadingUnit,
) -> calibrant::Result<Calibration> {
    let accelerometer = accelerometer(unit);
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

/// The recording of an accelerometer, in this unit where the file states none.
pub(crate) fn read_accelerometer(path: &Path, axes: usize, unit: ReadingUnit) -> Recording {
    let file = read_imu_recording(path, &ImuReadOptions::accelerometer(axes, unit)).expect("readable");
    file.recording[SensorKind::Accelerometer].clone().expect("there")
}
