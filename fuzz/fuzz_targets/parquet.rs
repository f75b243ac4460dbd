//! Fuzz target: a Parquet file is refused with an error, or its samples are finite and its times increase.
#![no_main]

use calibrant::io::{ImuReadOptions, parse_imu_recording};
use calibrant::sensor::SensorKind;
use libfuzzer_sys::fuzz_target;
use std::sync::Once;

static QUIET: Once = Once::new();

fuzz_target!(|bytes: &[u8]| {
    // the reader catches a panic of the crate that reads the format, and refuses the file; libFuzzer's hook
    // would abort before that
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| ())));
    let table = if bytes.starts_with(b"PAR1") { bytes.to_vec() } else { [b"PAR1", bytes, b"PAR1"].concat() };
    match parse_imu_recording(&table, &ImuReadOptions::default()) {
        Ok(file) => {
            for recording in SensorKind::ALL.into_iter().filter_map(|sensor_kind| file.recording.sensor(sensor_kind)) {
                let fine = recording.times_s().windows(2).all(|pair| pair[0] < pair[1])
                    && recording.readings().iter().all(|reading| reading.iter().all(|value| value.is_finite()));
                if !fine {
                    std::process::abort();
                }
            }
        }
        Err(error) if error.is_invalid_recording() && !error.to_string().is_empty() => (),
        Err(_) => std::process::abort(),
    }
});
