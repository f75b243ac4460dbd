//! Fuzz target: a recording of an IMU in any text format is refused with an error, or its samples are finite
//! and its times increase.
#![no_main]

use calibrant::io::{FileFormat, ImuFile, ImuReadOptions, ImuUnit, TimeUnit, inspect, InspectionFile, to_json, parse_imu_pair, parse_imu_recording};
use calibrant::sensor::SensorKind;
use libfuzzer_sys::fuzz_target;

fn check(outcome: calibrant::Result<ImuFile>) {
    match outcome {
        Ok(file) => {
            let sensors: Vec<_> = SensorKind::ALL.into_iter().filter_map(|sensor_kind| file.recording.sensor(sensor_kind)).collect();
            assert!(!sensors.is_empty() && file.columns.iter().any(|column| column.is_used()));
            for recording in &sensors {
                assert!(recording.len() >= 2 && recording.readings().len() == recording.len());
                assert!(recording.times_s().iter().all(|t| t.is_finite()));
                assert!(recording.times_s().windows(2).all(|pair| pair[0] < pair[1]));
                assert!(recording.readings().iter().all(|reading| reading.iter().all(|value| value.is_finite())));
            }
            if let Some(temperature) = &file.recording.temperature_c {
                assert!(temperature.len() == sensors[0].len() && temperature.iter().all(|t| t.is_finite()));
            }
            assert!(!to_json(&InspectionFile { file: &file, inspection: &inspect(&file) }).is_empty());
        }
        Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
    }
}

fuzz_target!(|bytes: &[u8]| {
    let reported = ImuReadOptions {
        time_unit: Some(TimeUnit::Millisecond),
        accelerometer_unit: Some(ImuUnit::Counts),
        gyroscope_unit: Some(ImuUnit::Counts),
        rate_hz: Some(100.0),
        ..ImuReadOptions::default()
    };
    for options in [ImuReadOptions::default(), reported.clone(), ImuReadOptions { rate_hz: Some(100.0), ..ImuReadOptions::default() }] {
        check(parse_imu_recording(bytes, &options));
        for format in FileFormat::ALL.into_iter().filter(|format| format.is_text()) {
            check(parse_imu_recording(bytes, &ImuReadOptions { format: Some(format), ..options.clone() }));
        }
    }
    let (first, second) = bytes.split_at(bytes.len() / 2);
    check(parse_imu_pair(first, second, &reported));
    check(parse_imu_pair(bytes, bytes, &reported));
});
