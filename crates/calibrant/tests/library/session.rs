//! The session gives what its stages give one by one, and writes it.

use crate::common::{draw_feeling_imu, run_imu};
use crate::common::{steady_holds, steady_imu};
use calibrant::diagnostic::Check;
use calibrant::diagnostic::holds::HoldMoved;
use calibrant::diagnostic::samples::Spikes;
use calibrant::estimate::{
    CalibrationProblem, CalibrationSettings, CalibrationStatus, Gyroscope, HoldsSetup, ImuSetup, NoiseSource,
    Stimulus, calibrate,
};
use calibrant::io::{Experiment, preset, write_imu_recording, write_motion, write_recording};
use calibrant::motion::{CommandedMotion, Gravity, KnownEnds, Limits, MotionClock, Trust};
use calibrant::sensor::{
    Gauge, ImuRecording, ReadingUnit, Recording, Sensor, SensorKind, SensorModel, SensorParameters,
};
use calibrant::session::{MotionSource, Outcome, Session, SessionOptions, Source};
use calibrant::simulate::{
    HoldsSimulation, ImuSimulation, Purpose, draw_sensor, initial_motion, sample_times, simulate_holds,
    simulate_imu, simulate_recording, stream,
};
use nalgebra::Vector3;
use std::path::Path;

const GRAVITY_MPS2: f64 = 9.806_65;

fn experiment(name: &str) -> Experiment {
    Experiment::parse(preset(name).expect("a preset"), None).expect("valid")
}

fn run(experiment: &Experiment, options: SessionOptions, file: &Path) -> calibrant::Result<Outcome> {
    Session::with(experiment.clone(), options)?.calibrate(&Source::from_file(file))
}

/// An accelerometer held still in 24 orientations.
fn held(seed: u64) -> Recording {
    let simulation = HoldsSimulation {
        poses: 24,
        hold_s: 3.0,
        turn_s: 1.5,
        rate_hz: 100.0,
        gravity_mps2: GRAVITY_MPS2,
        between_holds_sd_mps2: 0.0,
    };
    let (sensor, noise) = (SensorParameters::identity(), Vector3::repeat(0.01));
    let unit = ReadingUnit::MetrePerSecondSquared;
    simulate_holds(&sensor, &noise, unit, &simulation, &mut stream(seed, Purpose::Sensor, 0)).0
}

#[test]
fn an_accelerometer_is_calibrated_from_holds_and_validated() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name);
    let mut recording = held(1);
    // a spike within a hold
    recording.readings_mut()[100].x += 3.0;
    write_recording(&path("one.csv"), &recording).expect("written");
    write_recording(&path("other.csv"), &held(2)).expect("written");

    let experiment = experiment("static-poses");
    let options = SessionOptions {
        validate: Some(Source::from_file(path("other.csv"))),
        folds: Some(4),
        ..SessionOptions::default()
    };
    let outcome = run(&experiment, options, &path("one.csv")).expect("calibrated");
    let calibration = outcome.calibration();

    let setup = HoldsSetup {
        gravity: Gravity::SOMEWHERE,
        gauge: Gauge::Upper,
        bias_drift_sd_mps2: 0.02,
        ..steady_holds()
    };
    let problem = CalibrationProblem {
        sensor: &experiment.sensor,
        recording: &recording,
        stimulus: Stimulus::Holds(&setup),
    };
    let expected = calibrate(&problem, &CalibrationSettings::default()).expect("calibrated");
    assert_eq!(calibration.values, expected.values);
    assert_eq!(calibration.covariance, expected.covariance);
    let told = calibration.warnings.iter().filter(|found| found.code() == Spikes::CODE).count();
    assert_eq!((told, &calibration.warnings[0]), (1, &expected.warnings[0]), "the spike is told once");
    assert_eq!(calibration.warnings[1].code().name(), "left-out-negligible");
    assert_eq!(outcome.validations.len(), 2);
    assert_eq!(outcome.status(), CalibrationStatus::Converged);

    outcome.write(directory.path()).expect("written");
    let written = std::fs::read_to_string(path("calibration.json")).expect("written");
    assert_eq!(written, outcome.json());
    assert!(path("report.html").exists());
}

#[test]
fn an_accelerometer_is_calibrated_from_a_commanded_motion() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name);
    let experiment = experiment("report");
    let sensor = &experiment.sensor;
    // the experiment says 10 intervals
    let limits = Limits::default();
    let motion = initial_motion(12, 1.0, 3, &limits, &mut stream(1, Purpose::Motion, 0)).expect("a motion");
    let mut rng = stream(1, Purpose::Sensor, 0);
    let truth = draw_sensor(sensor, &mut rng);
    let times = sample_times(&motion, 10.0);
    let noise = sensor.noise_mps2.expect("given");
    let recording = simulate_recording(&truth, &noise, sensor.unit, 3, &motion, &times, &mut rng);
    write_recording(&path("recording.csv"), &recording).expect("written");
    write_motion(&path("motion.csv"), &motion, 3).expect("written");

    let without = run(&experiment, SessionOptions::default(), &path("recording.csv"));
    assert!(without.expect_err("no motion").is_invalid_experiment());
    let options = SessionOptions {
        motion: Some(path("motion.csv").into()),
        report: false,
        ..SessionOptions::default()
    };
    let session = Session::with(experiment.clone(), options).expect("prepared");
    assert!(matches!(session.notes(), [found] if found.message().contains("12 intervals")));
    let outcome = session.calibrate(&Source::from_file(path("recording.csv"))).expect("calibrated");
    let calibration = outcome.calibration();

    let command = CommandedMotion {
        motion,
        trust: Trust::Known,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
    };
    let problem = CalibrationProblem { sensor, recording: &recording, stimulus: Stimulus::Motion(&command) };
    let expected = calibrate(&problem, &CalibrationSettings::default()).expect("calibrated");
    assert_eq!(calibration.values, expected.values);
    assert_eq!(calibration.covariance, expected.covariance);
    outcome.write(directory.path()).expect("written");
    assert!(path("calibration.json").exists() && !path("report.html").exists());

    // motion and recording in memory give the same
    let options = SessionOptions {
        motion: Some(MotionSource::Commanded(command.motion.clone())),
        ..SessionOptions::default()
    };
    let in_memory = Session::with(experiment.clone(), options).expect("prepared");
    let in_memory = in_memory.calibrate(&Source::from_recording("recording", recording)).expect("calibrated");
    assert_eq!(in_memory.calibration().values, expected.values);
    assert_eq!(in_memory.origin.motion.as_ref().map(|motion| motion.sha256.len()), Some(64));
}

/// A whole IMU by hand.
fn imu_recording(seed: u64) -> ImuRecording {
    let imu = draw_feeling_imu(&mut stream(7, Purpose::Sensor, 0));
    let simulation = ImuSimulation { poses: 20, hold_s: 2.5, ..ImuSimulation::default() };
    simulate_imu(&imu, &simulation, &mut stream(seed, Purpose::Sensor, 1))
}

#[test]
fn an_imu_is_calibrated_and_not_validated_on_itself() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name);
    let recording = imu_recording(1);
    write_imu_recording(&path("one.csv"), &recording).expect("written");
    write_imu_recording(&path("other.csv"), &imu_recording(2)).expect("written");

    let experiment = experiment("imu");
    let on = |name: &str| SessionOptions {
        validate: Some(Source::from_file(path(name))),
        ..SessionOptions::default()
    };
    let outcome = run(&experiment, on("other.csv"), &path("one.csv")).expect("calibrated");
    let calibration = outcome.calibration();

    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let holds = HoldsSetup {
        gravity: Gravity::SOMEWHERE,
        gauge: Gauge::Lower,
        bias_drift_sd_mps2: 0.02,
        ..steady_holds()
    };
    let setup = ImuSetup { holds, ..steady_imu() };
    let expected =
        run_imu(&recording, &gyroscope, &setup, ReadingUnit::MetrePerSecondSquared).expect("calibrated");
    assert_eq!(experiment.sensor.model, Sensor::triaxial(SensorModel::Full).model);
    assert_eq!(calibration.values, expected.values);
    assert_eq!(calibration.covariance, expected.covariance);
    assert_eq!(calibration.warnings, expected.warnings);
    assert_eq!(
        calibration.gyroscope.as_ref().expect("an IMU").still.noise_source,
        NoiseSource::ScatterWithinHolds,
        "no hold is long"
    );
    assert_eq!(outcome.validations.len(), 1);
    outcome.write(directory.path()).expect("written");
    assert!(path("calibration.json").exists() && path("report.html").exists());

    let refused = run(&experiment, on("one.csv"), &path("one.csv")).expect_err("the same data");
    assert!(refused.to_string().contains("calibrated from"), "{refused}");
}

/// In four of twenty holds it turns about the vertical, by 2 °/s: these tell nothing of the gyroscope's bias, and the others do.
#[test]
fn holds_that_turn_do_not_count_where_the_others_tell_the_bias() {
    let mut recording = imu_recording(1);
    let force = recording[SensorKind::Accelerometer].clone().expect("there");
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    for ((t, reading), force) in force.times_s().iter().zip(gyroscope.readings_mut()).zip(force.readings()) {
        let (hold, since_s) = ((t / 4.5) as usize, t % 4.5);
        if hold % 5 == 3 && since_s < 2.5 {
            *reading += 0.035 * force.normalize();
        }
    }
    let session = Session::with(experiment("imu"), SessionOptions::default()).expect("prepared");
    let outcome = session.calibrate(&Source::from_recording("turning", recording)).expect("calibrated");
    let warnings = &outcome.calibration().warnings;
    assert!(warnings.iter().any(|found| found.code() == HoldMoved::CODE), "{warnings:?}");
    assert!(!outcome.verdict().codes.contains(&HoldMoved::CODE), "{:?}", outcome.verdict());
}

/// What was noticed before an error is not lost with it.
#[test]
fn notes_are_there_where_the_run_fails() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("recording.csv");
    let mut recording = imu_recording(3);
    // a second is missing, and all that follows the third hold
    let few = |recording: &mut Recording| {
        *recording = recording.only(|k| k < 1200 && !(450..550).contains(&k));
    };
    recording.sensors.values_mut().flatten().for_each(few);
    write_imu_recording(&file, &recording).expect("written");
    let experiment = experiment("imu");
    let session = Session::with(experiment.clone(), SessionOptions::default()).expect("prepared");
    let mut notes = Vec::new();
    let outcome = session.calibrate_noting(&Source::from_file(&file), &mut notes);
    assert!(outcome.expect_err("too few holds").is_not_identifiable());
    assert!(matches!(notes.as_slice(), [found] if found.file() == Some("recording.csv")), "{notes:?}");
}
