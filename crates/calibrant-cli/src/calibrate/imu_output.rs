//! What a calibrated IMU is written to, and shown as.

use super::Arguments;
use super::imu_noise::HoldNoise;
use crate::console;
use calibrant::estimate::ImuCalibration;
use calibrant::io::{ImuFile, Input, imu_calibration_json, write_atomically, write_imu_calibration};
use calibrant::report::{About, imu_calibration_report, number};

/// Writes calibration.json and report.html.
pub(super) fn write(
    arguments: &Arguments,
    calibration: &ImuCalibration,
    file: &ImuFile,
    noise: Vec<HoldNoise>,
    input: &Input,
) -> calibrant::Result<()> {
    let json = arguments.output.join("calibration.json");
    let json = || write_imu_calibration(&json, calibration, std::slice::from_ref(input));
    if arguments.no_report {
        super::warn_of_earlier_report(&arguments.output);
        return json();
    }
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
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    };
    let physical = |noise: HoldNoise| noise.physical(calibration, &file.recording);
    let noise = noise.into_iter().map(physical).collect::<calibrant::Result<Vec<_>>>()?;
    let report = || {
        let html = imu_calibration_report(calibration, &file.recording, &noise, &about);
        write_atomically(&arguments.output.join("report.html"), |out| out.write_all(html.as_bytes()))
    };
    let (json, report) = rayon::join(json, report);
    json.and(report)
}

/// Prints the tables, or calibration.json.
pub(super) fn show(arguments: &Arguments, calibration: &ImuCalibration, input: &Input) {
    if arguments.json {
        return console::print(&imu_calibration_json(calibration, std::slice::from_ref(input)));
    }
    console::print(&console::imu_calibration(calibration));
    console::print(&format!("\n{}\n", arguments.main_result().display()));
}
