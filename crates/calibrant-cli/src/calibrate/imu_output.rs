//! What a calibrated IMU is written to, and shown as.

use super::Arguments;
use crate::console;
use calibrant::estimate::ImuCalibration;
use calibrant::io::{ImuFile, Input, imu_calibration_json, write_atomically, write_imu_calibration};
use calibrant::noise::TriadNoise;
use calibrant::report::{About, imu_calibration_report, number};
use nalgebra::Vector3;
use std::time::Instant;

/// A hold shorter than this says too little of the noise to be plotted, s.
const LONG_HOLD_S: f64 = 20.0;

/// Writes calibration.json and report.html.
pub(super) fn write(
    arguments: &Arguments,
    calibration: &ImuCalibration,
    file: &ImuFile,
    input: &Input,
    started: Instant,
) -> calibrant::Result<()> {
    let json = arguments.output.join("calibration.json");
    write_imu_calibration(&json, calibration, std::slice::from_ref(input))?;
    let about = About {
        title: format!("Calibration of an IMU from {}", input.file),
        facts: vec![
            ("Recording".into(), input.file.clone()),
            ("Format".into(), file.format.name().into()),
            ("SHA-256".into(), input.sha256.clone()),
            (
                "Samples".into(),
                format!("{} at {} Hz", number::count(input.samples), number::significant(input.rate_hz, 5)),
            ),
            ("Experiment".into(), arguments.experiment.display().to_string()),
        ],
        findings: file.findings.iter().map(ToString::to_string).collect(),
        elapsed: Some(format!("{:.3} s", started.elapsed().as_secs_f64())),
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    };
    let html = imu_calibration_report(calibration, &file.recording, &noise(calibration, file), &about);
    write_atomically(&arguments.output.join("report.html"), |out| out.write_all(html.as_bytes()))
}

/// The noise of both sensors in the longest hold, where it is long enough.
fn noise(calibration: &ImuCalibration, file: &ImuFile) -> Vec<TriadNoise> {
    let holds = calibration.holds.holds.iter().map(|result| &result.hold);
    let Some(hold) = holds
        .max_by(|one, other| one.duration_s().total_cmp(&other.duration_s()))
        .filter(|hold| hold.duration_s() >= LONG_HOLD_S)
    else {
        return Vec::new();
    };
    TriadNoise::of_imu(&file.recording, (hold.start_s, hold.end_s), |triad| {
        let matrix = calibration.imu.triad(triad).matrix;
        Vector3::from_fn(|axis, _| matrix.row(axis).norm())
    })
}

/// Prints the tables, or calibration.json.
pub(super) fn show(arguments: &Arguments, calibration: &ImuCalibration, input: &Input) {
    if arguments.json {
        return console::print(&imu_calibration_json(calibration, std::slice::from_ref(input)));
    }
    console::print(&console::imu_calibration(calibration));
    console::print(&format!("\n{}\n", arguments.output.join("report.html").display()));
}
