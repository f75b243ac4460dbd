//! A session gives the same from arrays as from files.

use calibrant::budget::Budget;
use calibrant::error::Refusal;
use calibrant::estimate::Calibration;
use calibrant::io::{Experiment, preset, write_imu_recording};
use calibrant::sensor::{ImuParameters, Recording, SensorKind};
use calibrant::session::{MotionSource, Outcome, Readings, Session, SessionOptions, Source};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use calibrant::{Simulation, SimulationOptions, simulate};

fn experiment(name: &str) -> Experiment {
    Experiment::parse(preset(name).expect("it exists"), None).expect("valid")
}

fn estimates(outcome: &Outcome) -> (&[f64], Vec<f64>) {
    let calibration: &Calibration = outcome.calibration();
    (&calibration.values, calibration.sd().as_slice().to_vec())
}

/// The columns of a sensor.
fn columns(recording: &Recording) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| recording.readings().iter().map(|reading| reading[axis]).collect())
}

#[test]
fn an_imu_in_memory_is_that_of_its_file() {
    let simulation = ImuSimulation { poses: 20, ..ImuSimulation::default() };
    let recording = simulate_imu(&ImuParameters::identity(), &simulation, &mut stream(5, Purpose::Sensor, 0));
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("recording.csv");
    write_imu_recording(&path, &recording).expect("written");
    let [force, rate] = SensorKind::ALL.map(|kind| recording.sensor(kind).expect("both sensors"));
    let ([ax, ay, az], [gx, gy, gz]) = (columns(force), columns(rate));
    let table: [(&str, &[f64]); 7] = [
        ("t_s", force.times_s()),
        ("ax_mps2", &ax),
        ("ay_mps2", &ay),
        ("az_mps2", &az),
        ("gx_radps", &gx),
        ("gy_radps", &gy),
        ("gz_radps", &gz),
    ];
    let session = Session::new(experiment("imu")).expect("prepared");
    let of = |source: &Source| session.calibrate(source).expect("calibrated");
    let from_file = of(&Source::from_file(&path));
    let from_columns = of(&Source::from_columns("recording.csv", &table));
    let from_recording = of(&Source::from_recording("recording.csv", recording.clone()));
    let bytes = std::fs::read(&path).expect("there");
    let from_bytes = of(&Source::new(Readings::bytes("recording.csv", bytes)));
    assert_eq!(from_file.json(), from_bytes.json());
    assert_eq!(estimates(&from_file), estimates(&from_columns));
    assert_eq!(estimates(&from_file), estimates(&from_recording));
    let inputs = [&from_file, &from_columns].map(|outcome| &outcome.origin.inputs[0]);
    assert_eq!(inputs[0].file, inputs[1].file);
    assert_eq!((inputs[0].samples, inputs[0].rate_hz), (inputs[1].samples, inputs[1].rate_hz));
    assert!(inputs[1].sha256.len() == 64 && inputs[0].sha256 != inputs[1].sha256);
    assert!(from_columns.report_html().contains("<dt>Format</dt><dd>columns<"));
    // one sensor in each table
    let [times, other] = [force.times_s(), rate.times_s()];
    let mut pair = Source::from_columns("a.csv", &table[..4]);
    assert_eq!(times, other);
    let of_gyroscope: Vec<(&str, &[f64])> =
        [table[0]].into_iter().chain(table[4..].iter().copied()).collect();
    pair.gyroscope = Some(Readings::columns("g.csv", &of_gyroscope));
    assert_eq!(estimates(&from_file), estimates(&of(&pair)));
    // the data that were calibrated from are refused in memory, too
    let options = SessionOptions { validate: Some(pair), ..SessionOptions::default() };
    let refused = Session::with(experiment("imu"), options).expect("prepared");
    let refused = refused.calibrate(&Source::from_file(&path)).expect_err("the same data").to_string();
    assert!(refused.contains("calibrated from"), "{refused}");
}

#[test]
fn a_calibration_on_a_machine_beyond_the_budget_is_refused_before_it_begins() {
    let experiment = experiment("rate-table");
    let Simulation { recording, log: Some((log, _)), .. } =
        simulate(&experiment, &SimulationOptions::default()).expect("simulated")
    else {
        panic!("a log")
    };
    let within = |seconds: f64| {
        let mut options =
            SessionOptions { motion: Some(MotionSource::Logged(log.clone())), ..SessionOptions::default() };
        options.reading.budget = Some(Budget { seconds, ..Budget::USUAL });
        let source = Source::from_recording("recording.csv", recording.clone());
        Session::with(experiment.clone(), options).expect("prepared").calibrate(&source)
    };
    let error = within(0.1).expect_err("too long");
    assert_eq!(error.code(), Refusal::WorkTooLarge);
    assert!(error.to_string().contains("a calibration from a log of 12401 rows would take about"), "{error}");
    assert!(within(100.0).is_ok());
}
