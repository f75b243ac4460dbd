//! Tests of real recordings of accelerometers.

use crate::common::shared_data;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::SamplingIrregular;
use calibrant::io::{ImuReadOptions, read_imu_recording};
use calibrant::sensor::{ReadingUnit, SensorKind};

#[test]
fn the_xsens_recording_of_imu_tk_reads_whole() {
    let Some(path) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let options = ImuReadOptions::accelerometer(3, ReadingUnit::Counts);
    let file = read_imu_recording(&path, &options).expect("good");
    let recording = file.recording[SensorKind::Accelerometer].clone().expect("there");
    assert_eq!((recording.len(), file.rows), (51_175, 51_175));
    assert_eq!(recording.unit(), ReadingUnit::Counts);
    assert_eq!(recording.readings()[0].as_slice(), [33108.0, 33329.0, 36429.0]);
    assert_eq!(recording.times_s().last(), Some(&511.718));
    assert!((recording.rate_hz() - 100.0).abs() < 0.2, "{}", recording.rate_hz());
    let kinds: Vec<_> = file.findings.iter().map(|finding| finding.code()).collect();
    assert_eq!(kinds, [SamplingIrregular::CODE], "{:?}", file.findings);
}

#[test]
fn a_recording_of_another_tool_asks_for_what_it_does_not_state() {
    let Some(path) = shared_data("imucal-ferraris/example_ferraris_session.csv") else { return };
    let options = ImuReadOptions::accelerometer(3, ReadingUnit::MetrePerSecondSquared);
    let error = read_imu_recording(&path, &options).expect_err("no units").to_string();
    assert!(error.contains("the accelerometer's columns have no unit: "), "{error}");
    assert!(
        error.contains("the file has no sample times, and nothing in it says the sample rate"),
        "{error}"
    );
}
