//! Tests of real recordings of accelerometers.

use crate::common::shared_data;
use calibrant::diagnostic::Code;
use calibrant::io::{ReadOptions, read_recording};
use calibrant::sensor::ReadingUnit;

#[test]
fn the_xsens_recording_of_imu_tk_reads_whole() {
    let Some(path) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let options = ReadOptions { unit: None, expected_unit: ReadingUnit::Counts, axes: 3 };
    let file = read_recording(&path, &options).expect("good");
    assert_eq!((file.recording.len(), file.lines), (51_175, 51_175));
    assert_eq!(file.recording.unit, ReadingUnit::Counts);
    assert_eq!(file.recording.readings[0].as_slice(), [33108.0, 33329.0, 36429.0]);
    assert_eq!(file.recording.times_s.last(), Some(&511.718));
    assert!((file.recording.rate_hz() - 100.0).abs() < 0.2, "{}", file.recording.rate_hz());
    let kinds: Vec<_> = file.findings.iter().map(|finding| finding.code()).collect();
    assert_eq!(kinds, [Code::SamplingIrregular], "{:?}", file.findings);
}

#[test]
fn a_recording_of_another_tool_is_refused_with_its_columns() {
    let Some(path) = shared_data("imucal-ferraris/example_ferraris_session.csv") else { return };
    let options = ReadOptions { unit: None, expected_unit: ReadingUnit::MetrePerSecondSquared, axes: 3 };
    let error = read_recording(&path, &options).expect_err("other columns").to_string();
    assert!(
        error.contains(":1: columns t_s, ax, ay, az missing; the columns are `n_samples`, `gyr_x`, "),
        "{error}"
    );
}
