//! Fuzz target: a ROS 2 bag is refused with an error, or its samples are finite and its times increase.
#![no_main]

use calibrant::io::{ImuReadOptions, parse_imu_recording};
use calibrant::sensor::SensorKind;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let magic = b"\x89MCAP0\r\n";
    let bag = if bytes.starts_with(magic) { bytes.to_vec() } else { [magic, bytes].concat() };
    match parse_imu_recording(&bag, &ImuReadOptions::default()) {
        Ok(file) => {
            for recording in SensorKind::ALL.into_iter().filter_map(|sensor_kind| file.recording.sensor(sensor_kind)) {
                assert!(recording.times_s().windows(2).all(|pair| pair[0] < pair[1]));
                assert!(recording.readings().iter().all(|reading| reading.iter().all(|value| value.is_finite())));
            }
        }
        Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
    }
});
