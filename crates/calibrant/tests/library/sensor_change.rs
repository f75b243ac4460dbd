//! Tests of a sensor that changes within a recording: the change is reported. No change is reported of other
//! sensors.

use crate::common::messages;
use crate::common::{draw_imu, normal, run_imu};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::diagnostic::Check;
use calibrant::diagnostic::change::SensorChanged;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, Change, Changed, Course, CovarianceVerdict,
    ErrorKind, Gyroscope, HoldsSetup, ImuProblem, ImuSetup, Recovered, Stimulus, calibrate, calibrate_imu,
    cross_validate_imu,
};
use calibrant::report::validation_sentences;
use calibrant::sensor::{ImuRecording, ReadingUnit, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::Vector3;
use rayon::prelude::*;

fn simulated(seed: u64, number: u64, simulation: &ImuSimulation) -> ImuRecording {
    let mut rng = stream(seed, Purpose::Sensor, number);
    simulate_imu(&draw_imu(&mut rng), simulation, &mut rng)
}

fn run(recording: &ImuRecording, gyroscope: &Gyroscope) -> Calibration {
    let unit = ReadingUnit::MetrePerSecondSquared;
    run_imu(recording, gyroscope, &steady_imu(), unit).expect("determined")
}

/// From a time on, one axis of a sensor reads `gain` times as much and `bias` more.
fn from(
    recording: &mut ImuRecording,
    time_s: f64,
    sensor_kind: SensorKind,
    axis: usize,
    (gain, bias): (f64, f64),
) {
    let sensor = match sensor_kind {
        SensorKind::Accelerometer => recording[SensorKind::Accelerometer].as_mut(),
        SensorKind::Gyroscope => recording[SensorKind::Gyroscope].as_mut(),
    };
    let sensor = sensor.expect("there");
    for (t, reading) in sensor.samples_mut() {
        if *t >= time_s {
            reading[axis] = gain * reading[axis] + bias;
        }
    }
}

/// Of good recordings fewer than one in two hundred show a change. They have many and few holds, an assumed
/// noise of a third or three times its value, a scatter between holds, and holds that move.
#[test]
fn a_sensor_that_does_not_change_is_not_accused() {
    let accused = |number: u64| {
        let poses = [16, 24, 40][(number % 3) as usize];
        let simulation = ImuSimulation { poses, rate_hz: 50.0, ..ImuSimulation::default() };
        let mut recording = simulated(401, number, &simulation);
        let mut rng = stream(402, Purpose::Sensor, number);
        let noise_radps = [None, Some(2e-3 / 3.0), Some(6e-3)][(number / 3 % 3) as usize];
        let scatter = [0.0, 3e-3][(number / 9 % 2) as usize];
        let bad = number.is_multiple_of(5);
        let pushes: Vec<Vector3<f64>> = (0..poses)
            .map(|k| {
                let size = if bad && k % 11 == 3 { 0.1 } else { scatter };
                Vector3::from_fn(|_, _| size * normal(&mut rng))
            })
            .collect();
        let accelerometer = recording[SensorKind::Accelerometer].as_mut().expect("there");
        for (t, reading) in accelerometer.samples_mut() {
            *reading += pushes[((t / 4.5) as usize).min(poses - 1)];
        }
        let gyroscope = Gyroscope { noise: noise_radps.map(Vector3::repeat), ..unfeeling_gyroscope() };
        run(&recording, &gyroscope).changes.first().copied()
    };
    let accused: Vec<Change> = (0..400).into_par_iter().filter_map(accused).collect();
    assert!(accused.len() <= 1, "{accused:#?}");
}

#[test]
fn a_step_is_found_and_its_sensor_its_kind_and_its_time_are_told() {
    let cases = [
        (SensorKind::Accelerometer, Changed::Bias, (1.0, 0.05), 0.05),
        (SensorKind::Accelerometer, Changed::Gain, (1.005, 0.0), 0.005),
        (SensorKind::Gyroscope, Changed::Bias, (1.0, 0.01), 0.01),
        (SensorKind::Gyroscope, Changed::Gain, (1.01, 0.0), 0.01),
    ];
    let simulation = ImuSimulation { poses: 28, ..ImuSimulation::default() };
    for (sensor_kind, of, by, amount) in cases {
        (0..12_u64).into_par_iter().for_each(|number| {
            let mut recording = simulated(403, number, &simulation);
            let axis = (number % 3) as usize;
            // in the turn after hold 14, or after hold 22
            let last = [13, 21][(number / 3 % 2) as usize];
            from(&mut recording, 4.5 * last as f64 + 3.5, sensor_kind, axis, by);
            let calibration = run(&recording, &unfeeling_gyroscope());
            let change = calibration
                .changes
                .iter()
                .find(|change| (change.sensor_kind, change.of) == (sensor_kind, of));
            let change =
                change.unwrap_or_else(|| panic!("{sensor_kind} {of:?} {number}: {:#?}", calibration.changes));
            let Course::Step { before, after, time_s } = change.course else { panic!("{change:?}") };
            assert!(
                before.abs_diff(last) <= 2 && after.abs_diff(last + 1) <= 2,
                "{sensor_kind} {of:?} {number}: {change:?}"
            );
            assert!((time_s - 4.5 * last as f64 - 3.5).abs() < 10.0, "{change:?}");
            let off = (change.amount[axis] - amount).abs();
            // a step that is found a turn early or late is diluted
            let misplaced = (before.abs_diff(last) + after.abs_diff(last + 1)) as f64;
            let most = 5.0 * change.sd[axis] + 0.1 * amount * (1.0 + misplaced);
            assert!(off < most, "{sensor_kind} {of:?} {number}: {change:?}");
            let message = &messages(&calibration.warnings)[0];
            assert!(
                message.contains("changes at about") && message.contains("holds.intervals_s"),
                "{message}"
            );
        });
    }
}

/// A bias that is off for the middle third is no single step: the warning gives both ends, and the shift in
/// between.
#[test]
fn a_bias_that_comes_and_goes_is_an_episode() {
    let simulation = ImuSimulation { poses: 36, ..ImuSimulation::default() };
    let changes = (0..12_u64).into_par_iter().map(|number| {
        let mut recording = simulated(408, number, &simulation);
        let axis = (number % 3) as usize;
        for (hold, step) in [(11.0, 0.05), (23.0, -0.05)] {
            from(&mut recording, 4.5 * hold + 3.5, SensorKind::Accelerometer, axis, (1.0, step));
        }
        let calibration = run(&recording, &unfeeling_gyroscope());
        let change = calibration.changes.first().copied();
        if let Some(change) = change.filter(|change| matches!(change.course, Course::Episode { .. })) {
            let message = &messages(&calibration.warnings)[0];
            assert!(
                message.contains("changes at about") && message.contains("and back at about"),
                "{message}"
            );
            let off = (change.amount[axis] - 0.05).abs();
            assert!(off < 5.0 * change.sd[axis] + 0.005, "{number}: {change:?}");
        }
        change
    });
    let changes: Vec<Option<Change>> = changes.collect();
    let is_reported = |change: &&Change| match change.course {
        Course::Episode { first, last, start_s, end_s } => {
            first.abs_diff(12) <= 2
                && last.abs_diff(23) <= 2
                && (start_s - 4.5 * 11.0 - 3.5).abs() < 10.0
                && (end_s - 4.5 * 23.0 - 3.5).abs() < 10.0
        }
        _ => false,
    };
    assert!(changes.iter().flatten().filter(is_reported).count() >= 10, "{changes:#?}");
}

/// Of a few holds at the end, each looks like an outlier.
#[test]
fn holds_that_are_left_out_in_a_row_are_a_change() {
    let simulation = ImuSimulation { poses: 30, ..ImuSimulation::default() };
    let mut named = 0;
    for number in 0..6 {
        let mut recording = simulated(404, number, &simulation);
        from(&mut recording, 4.5 * 23.0 + 3.5, SensorKind::Accelerometer, 0, (1.0, 0.3));
        let calibration = run(&recording, &unfeeling_gyroscope());
        let says =
            |words: &str| messages(&calibration.warnings).iter().any(|message| message.contains(words));
        assert!(
            says("the accelerometer changes at about") || says("consecutive"),
            "{:#?}",
            calibration.warnings
        );
        named += usize::from(calibration.hold_results().iter().filter(|hold| !hold.used).count() > 2);
    }
    assert!(named > 0, "some of them leave holds out");
}

#[test]
fn a_drift_is_told_and_temperature_pointed_at() {
    let simulation =
        ImuSimulation { poses: 30, temperature_c: Some([20.0, 38.0]), ..ImuSimulation::default() };
    let mut recording = simulated(405, 0, &simulation);
    let accelerometer = recording[SensorKind::Accelerometer].as_mut().expect("there");
    let end_s = accelerometer.times_s().last().copied().expect("samples");
    for (t, reading) in accelerometer.samples_mut() {
        reading.y += 0.04 * t / end_s;
    }
    let with_temperature = run(&recording, &unfeeling_gyroscope());
    let drift = with_temperature.changes[0];
    assert_eq!((drift.sensor_kind, drift.course), (SensorKind::Accelerometer, Course::Drift));
    assert!((drift.amount.y - 0.04).abs() < 5.0 * drift.sd.y, "{drift:?}");
    assert!(
        messages(&with_temperature.warnings)[0].contains("from 20.0 to 38.0 °C"),
        "{}",
        messages(&with_temperature.warnings)[0]
    );
    recording.temperature_c = None;
    let without = run(&recording, &unfeeling_gyroscope());
    assert!(messages(&without.warnings)[0].contains("warm up"), "{}", messages(&without.warnings)[0]);
}

#[test]
fn an_accelerometer_alone_is_told_too() {
    let simulation = ImuSimulation { poses: 24, ..ImuSimulation::default() };
    let sensor = Sensor::triaxial(SensorModel::Full);
    let setup = steady_holds();
    for (step, changes) in [(0.0, false), (0.05, true)] {
        let mut recording = simulated(406, 1, &simulation);
        from(&mut recording, 4.5 * 11.0 + 3.5, SensorKind::Accelerometer, 2, (1.0, step));
        let recording = recording[SensorKind::Accelerometer].as_ref().expect("there");
        let problem = CalibrationProblem { sensor: &sensor, recording, stimulus: Stimulus::Holds(&setup) };
        let calibration = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
        let Recovered::Holds(holds) = &calibration.recovered else { panic!("holds") };
        assert_eq!(holds.change.is_some(), changes, "{:?}", holds.change);
        let says = messages(&calibration.warnings)
            .iter()
            .any(|message| message.contains("the accelerometer changes at about"));
        assert_eq!(says, changes, "{:#?}", calibration.warnings);
    }
}

/// The rest of a recording predicts each part of it as well as the scatter between both promises.
#[test]
fn folds_of_a_sensor_that_changes_are_not_believed() {
    let simulation = ImuSimulation { poses: 28, ..ImuSimulation::default() };
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let (gyroscope, setup) = (unfeeling_gyroscope(), steady_imu());
    let cases = [
        (None, &[][..]),
        (Some((SensorKind::Accelerometer, (1.0, 0.05))), &[ErrorKind::Magnitude, ErrorKind::Rotation]),
        (Some((SensorKind::Gyroscope, (1.0, 0.01))), &[ErrorKind::Rate]),
        (Some((SensorKind::Gyroscope, (1.01, 0.0))), &[ErrorKind::Rotation]),
    ];
    for (step, doubted) in cases {
        let mut recording = simulated(407, 2, &simulation);
        if let Some((sensor_kind, by)) = step {
            from(&mut recording, 4.5 * 13.0 + 3.5, sensor_kind, 0, by);
        }
        let problem = ImuProblem {
            accelerometer: &accelerometer,
            gyroscope: &gyroscope,
            recording: &recording,
            setup: &setup,
        };
        let settings = CalibrationSettings::default();
        let calibration = calibrate_imu(&problem, &settings).expect("determined");
        let validation = cross_validate_imu(&calibration, &problem, &settings, 5).expect("predicted");
        let sentences = validation_sentences(&validation).join("\n");
        for errors in &validation.kinds {
            let is_doubted =
                errors.caveat.as_ref().is_some_and(|caveat| caveat.code() == SensorChanged::CODE);
            assert!(step.is_some() || errors.caveat.is_none(), "{errors:#?}");
            assert!(is_doubted || !doubted.contains(&errors.kind), "{step:?}: {errors:#?}");
            assert!(
                !is_doubted || errors.verdict != CovarianceVerdict::Believed,
                "{step:?} {:?}",
                errors.kind
            );
        }
        let says = sentences.contains("but they confirm nothing: the ") || sentences.contains("too small");
        assert_eq!(says, step.is_some(), "{sentences}");
    }
}

/// A real sensor of good quality shows no change.
#[test]
fn the_xsens_is_the_same_throughout() {
    let Some((recording, gravity)) = crate::common::xsens() else { return };
    let unit = ReadingUnit::Counts;
    let accelerometer = Sensor { unit, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) };
    let setup = ImuSetup { holds: HoldsSetup { gravity, ..steady_holds() }, ..steady_imu() };
    for g_sensitivity in [false, true] {
        let gyroscope = Gyroscope { unit, g_sensitivity, ..Gyroscope::default() };
        let problem = ImuProblem {
            accelerometer: &accelerometer,
            gyroscope: &gyroscope,
            recording: &recording,
            setup: &setup,
        };
        let calibration = calibrate_imu(&problem, &CalibrationSettings::default()).expect("determined");
        assert_eq!(calibration.changes, [], "{:#?}", calibration.changes);
    }
}
