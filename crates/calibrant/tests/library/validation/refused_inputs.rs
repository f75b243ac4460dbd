//! Tests of inputs that cannot be validated.

use crate::common::draw_imu;
use crate::common::steady_imu;
use crate::validation::bench::bench;
use calibrant::estimate::{CalibrationSettings, ImuProblem, cross_validate_imu, validate_imu};
use calibrant::sensor::{ImuRecording, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::Vector3;

#[test]
fn what_cannot_be_validated_is_refused_with_the_reason() {
    let simulation = ImuSimulation { poses: 14, ..ImuSimulation::default() };
    let bench = bench(&simulation);
    let mut rng = stream(29, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let recording = simulate_imu(&truth, &simulation, &mut rng);
    let calibration = bench.calibrate(&recording);
    let settings = CalibrationSettings::default();
    let folds = |folds: usize| {
        cross_validate_imu(&calibration, &bench.problem(&recording), &settings, folds)
            .expect_err("refused")
            .to_string()
    };
    for count in [0, 1, 15] {
        let message = folds(count);
        assert!(message.contains(&format!("{count} folds cannot be made of 14 used holds")), "{message}");
    }
    // half of the holds do not determine an accelerometer
    let message = folds(2);
    assert!(
        message.contains("none of the 2 folds can be predicted") && message.contains("without holds 1 to 7"),
        "{message}"
    );
    let mut setup = bench.setup.clone();
    setup.directions = Some(vec![Vector3::z(); 14]);
    let known = ImuProblem { setup: &setup, ..bench.problem(&recording) };
    let message = cross_validate_imu(&calibration, &known, &settings, 5).expect_err("refused").to_string();
    assert!(message.contains("how well the sensor was placed"), "{message}");

    let anywhere = steady_imu();
    let refused = |recording: &ImuRecording| {
        let problem = ImuProblem { setup: &anywhere, ..bench.problem(recording) };
        let error = validate_imu(&calibration, &problem).expect_err("refused");
        assert!(error.is_invalid_recording(), "{error}");
        error.to_string()
    };
    let without = recording.clone().with(SensorKind::Gyroscope, None);
    assert!(refused(&without).contains("the recording has no gyroscope"));
    let mut restless = recording.clone();
    for sensor in restless.sensors.values_mut() {
        for (k, y) in sensor.as_mut().expect("there").readings_mut().iter_mut().enumerate() {
            *y += Vector3::repeat(3.0 * (k as f64 * 0.9).sin() * (1.0 + k as f64 * 1e-3));
        }
    }
    let message = refused(&restless);
    assert!(message.contains("no holds") || message.contains("miss the magnitude"), "{message}");
    let mut another = recording.clone();
    another[SensorKind::Accelerometer]
        .as_mut()
        .expect("there")
        .readings_mut()
        .iter_mut()
        .for_each(|y| *y *= 0.1);
    assert!(refused(&another).contains("its holds miss the magnitude of gravity by 8.8"));
}
