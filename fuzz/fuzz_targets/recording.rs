//! Fuzz target: a recording is refused with an error, or its samples are finite and its times increase.
#![no_main]

use calibrant::io::{ReadOptions, parse_recording};
use calibrant::sensor::ReadingUnit;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for axes in [1, 3] {
        for unit in [None, Some(ReadingUnit::Counts)] {
            let options = ReadOptions { unit, expected_unit: ReadingUnit::MetrePerSecondSquared, axes };
            match parse_recording(bytes, &options) {
                Ok(file) => {
                    let recording = file.recording;
                    assert!(recording.len() >= 2 && recording.readings.len() == recording.len());
                    assert!(recording.times_s.windows(2).all(|pair| pair[0] < pair[1]));
                    assert!(recording.readings.iter().all(|reading| reading.iter().all(|value| value.is_finite())));
                    assert!(file.findings.iter().all(|finding| !finding.to_string().is_empty()));
                    assert!(file.findings.iter().all(|finding| finding.line.is_none_or(|line| line <= file.lines)));
                }
                Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
            }
        }
    }
});
