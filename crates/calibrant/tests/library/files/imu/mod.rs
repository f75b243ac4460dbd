//! Tests of recordings of a whole IMU: every format, every question, every message.

mod accelerometer_only;
mod autopilots;
mod broken;
mod clocks;
mod good;
mod host_times;
mod invalid_samples;
mod layouts;
mod other_bags;
mod packets;
mod parquet;
mod pieces;
mod real;
mod remedies;
pub(super) mod ros_bag;
mod separate_rows;

use calibrant::io::{ImuFile, ImuReadOptions, ImuUnit, parse_imu_recording};

/// Options with both units given.
fn units(accelerometer: ImuUnit, gyroscope: ImuUnit) -> ImuReadOptions {
    ImuReadOptions {
        accelerometer_unit: Some(accelerometer),
        gyroscope_unit: Some(gyroscope),
        ..ImuReadOptions::default()
    }
}

fn read(text: &str, options: &ImuReadOptions) -> ImuFile {
    parse_imu_recording(text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refused(text: &str, options: &ImuReadOptions) -> String {
    let error = parse_imu_recording(text.as_bytes(), options).expect_err("refused");
    assert!(error.is_invalid_recording());
    error.to_string()
}

/// The findings, in words.
fn findings(file: &ImuFile) -> Vec<String> {
    file.findings.iter().map(ToString::to_string).collect()
}

/// The columns that are used.
fn used(file: &ImuFile) -> Vec<&str> {
    file.columns.iter().filter(|column| column.is_used()).map(|column| column.name.as_str()).collect()
}
