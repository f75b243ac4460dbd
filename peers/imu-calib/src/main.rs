//! Calibrates an IMU with the crate imu-calib from imu_tk's pair of files, `t x y z` each, readings in counts.
//!
//! usage: imu-calib-peer ACCELEROMETER GYROSCOPE
//!
//! The crate reads no recordings, takes readings in m/s² and rad/s, and starts its iterations from a perfect
//! sensor. So the standard library parses the rows here, and the counts are divided by nominal gains of an
//! Xsens MTi. (calibrant finds the gains by itself.)

use imu_calib::estimate::{RecordingConfig, Sample, calibrate_recording};
use std::error::Error;
use std::time::Instant;

/// Middle of 16 bits, counts.
const ZERO: f64 = 32768.0;
/// Counts per m/s² and per rad/s.
const GAINS: [f64; 2] = [415.0, 4770.0];
/// Local gravity where the recording was made, m/s²: as for imu_tk.
const GRAVITY: f64 = 9.81744;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [accelerometer, gyroscope] = arguments.as_slice() else {
        return Err("usage: imu-calib-peer ACCELEROMETER GYROSCOPE".into());
    };
    let started = Instant::now();
    let (accelerometer, gyroscope) = (read(accelerometer, GAINS[0])?, read(gyroscope, GAINS[1])?);
    let samples: Vec<Sample> =
        accelerometer.iter().zip(&gyroscope).map(|(force, rate)| (force.0, force.1, rate.1)).collect();
    let read_s = started.elapsed().as_secs_f64();
    let config = RecordingConfig { gravity: GRAVITY, ..RecordingConfig::default() };
    let calibration = calibrate_recording(&samples, &config)?;
    let total_s = started.elapsed().as_secs_f64();

    let found = &calibration.intrinsics;
    let counts = |matrix: &[[f64; 3]; 3], gain: f64| matrix.map(|row| row.map(|entry| entry * gain));
    println!("accelerometer, counts/(m/s²): {:.3?}", counts(&found.accel_m, GAINS[0]));
    println!("gyroscope, counts/(rad/s): {:.2?}", counts(&found.gyro_m, GAINS[1]));
    print!("{}", calibration.report.summary());
    println!("reading {read_s:.4} s, all {total_s:.4} s");
    Ok(())
}

/// Rows `t x y z` of a file, the readings over a gain.
fn read(path: &str, gain: f64) -> Result<Vec<(f64, [f64; 3])>, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    text.lines()
        .map(|line| {
            let mut fields = line.split_ascii_whitespace().map(str::parse::<f64>);
            let mut next =
                || fields.next().ok_or("a row has fewer than four columns")?.map_err(Box::<dyn Error>::from);
            let (t, x, y, z) = (next()?, next()?, next()?, next()?);
            Ok((t, [x, y, z].map(|counts| (counts - ZERO) / gain)))
        })
        .collect()
}
