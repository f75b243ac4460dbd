//! Fuzz target: a bag in SQLite, a ROS 1 bag, a log of PX4 or of ArduPilot is refused with an error, or its samples are finite and its times increase.
#![no_main]

use calibrant::io::{ImuReadOptions, parse_imu_recording};
use calibrant::sensor::SensorKind;
use libfuzzer_sys::fuzz_target;

const MAGICS: [&[u8]; 4] = [b"SQLite format 3\0", b"#ROSBAG V2.0\n", b"ULog\x01\x12\x35\x01", b"\xa3\x95\x80"];

fuzz_target!(|bytes: &[u8]| {
    let Some((first, rest)) = bytes.split_first() else { return };
    let is_whole = MAGICS.iter().any(|magic| bytes.starts_with(magic));
    let file = if is_whole { bytes.to_vec() } else { [MAGICS[usize::from(first % 4)], rest].concat() };
    match parse_imu_recording(&file, &ImuReadOptions::default()) {
        Ok(file) => {
            for recording in SensorKind::ALL.into_iter().filter_map(|sensor_kind| file.recording.sensor(sensor_kind)) {
                assert!(recording.times_s().windows(2).all(|pair| pair[0] < pair[1]));
                assert!(recording.readings().iter().all(|reading| reading.iter().all(|value| value.is_finite())));
            }
        }
        Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
    }
});
