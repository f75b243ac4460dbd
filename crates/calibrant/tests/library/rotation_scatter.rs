//! A gyroscope whose rotations do not fit: what is the same for all is named, and what scatters is not absorbed into weights.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, run_imu, steady_imu, unfeeling_gyroscope};
use calibrant::diagnostic::Diagnostic;
use calibrant::error::Refusal;
use calibrant::estimate::{Calibration, Gyroscope, ImuSetup};
use calibrant::sensor::{ImuRecording, ReadingUnit, SensorKind};
use calibrant::simulate::{Purpose, stream};
use nalgebra::Vector3;

/// A recording by hand whose gyroscope reads this of what it should.
fn recorded(number: u64, read: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> ImuRecording {
    let mut rng = stream(95, Purpose::Sensor, number);
    let mut recording = ByHand::default().record(&draw_imu(&mut rng), &mut rng);
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("recorded");
    gyroscope.readings_mut().iter_mut().for_each(|reading| *reading = read(reading));
    recording
}

fn run(recording: &ImuRecording, gyroscope: &Gyroscope, setup: &ImuSetup) -> calibrant::Result<Calibration> {
    run_imu(recording, gyroscope, setup, ReadingUnit::MetrePerSecondSquared)
}

fn codes(found: &Calibration) -> Vec<&'static str> {
    found.warnings.iter().map(Diagnostic::code).map(|code| code.name()).collect()
}

#[test]
fn one_factor_on_all_gains_is_named_with_its_value() {
    for factor in [0.2706, 0.5, 0.875, 1.147, 2.0, 4.0] {
        let recording = recorded(1, |reading| reading * factor);
        let said = match run(&recording, &unfeeling_gyroscope(), &steady_imu()) {
            Ok(found) => {
                found.warnings.iter().map(ToString::to_string).find(|said| said.contains("times the turns"))
            }
            Err(error) => {
                assert_eq!(
                    error.input_error().map(|input| input.code),
                    Some(Refusal::GyroscopeScaled),
                    "{error}"
                );
                Some(error.to_string())
            }
        };
        let said = said.unwrap_or_else(|| panic!("{factor}"));
        let stated = said.split("reads ").nth(1).and_then(|rest| rest.split(' ').next());
        let stated: f64 = stated.and_then(|stated| stated.parse().ok()).expect("a factor");
        // to its last digit, and gains of some per cent of their own
        assert!((stated / factor - 1.0).abs() < 0.03, "{factor}: {said}");
    }
}

#[test]
fn a_range_that_wraps_or_compresses_is_no_sound_result() {
    let (range, most) = (500_f64.to_radians(), 325_f64.to_radians());
    let wraps =
        |reading: &Vector3<f64>| reading.map(|rate| (1.6 * rate + range).rem_euclid(2.0 * range) - range);
    let compresses = |reading: &Vector3<f64>| reading.map(|rate| most * (1.6 * rate / most).tanh());
    for number in 0..3 {
        for (name, recording) in
            [("wraps", recorded(number, wraps)), ("compresses", recorded(number, compresses))]
        {
            match run(&recording, &unfeeling_gyroscope(), &steady_imu()) {
                Ok(found) => assert!(
                    codes(&found).iter().any(|code| [
                        "rotations-scatter",
                        "rotation-left-out",
                        "gyroscope-scaled"
                    ]
                    .contains(code)),
                    "{name} {number}: {:?}",
                    codes(&found)
                ),
                Err(error) => assert!(error.is_invalid_recording(), "{error}"),
            }
        }
        let sound = run(&recorded(number, |reading| *reading), &unfeeling_gyroscope(), &steady_imu());
        let found = codes(&sound.expect("determined")).join(" ");
        assert!(!found.contains("scatter") && !found.contains("gain"), "{found}");
    }
}

/// Far below the range a gyroscope may compress by so little that the rotations seem to fit, and the gains be wrong by many standard deviations.
#[test]
fn a_gain_that_falls_with_the_rate_is_named() {
    let most = 600_f64.to_radians();
    let compresses = |reading: &Vector3<f64>| reading.map(|rate| most * (rate / most).tanh());
    let mut named = 0;
    for number in 0..6 {
        let found = run(&recorded(number, compresses), &unfeeling_gyroscope(), &steady_imu());
        let found = codes(&found.expect("determined"));
        named += usize::from(found.contains(&"gain-depends-on-rate") || found.contains(&"rotation-left-out"));
        let sound = run(&recorded(number, |reading| *reading), &unfeeling_gyroscope(), &steady_imu());
        assert!(!codes(&sound.expect("determined")).contains(&"gain-depends-on-rate"), "{number}");
    }
    assert!(named >= 5, "{named} of 6");
}

#[test]
fn a_rate_that_nobody_measured_leaves_no_gain_that_is_known() {
    let recording = recorded(2, |reading| *reading);
    let found = |rate_sd: f64| run(&recording, &unfeeling_gyroscope(), &ImuSetup { rate_sd, ..steady_imu() });
    assert!(codes(&found(0.05).expect("determined")).contains(&"gains-uncertain"));
    assert!(!codes(&found(1e-3).expect("determined")).contains(&"gains-uncertain"));
}
