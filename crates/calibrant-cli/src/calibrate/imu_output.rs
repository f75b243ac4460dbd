//! What a calibrated IMU is written to, and shown as.

use super::Arguments;
use super::imu_noise::physical;
use crate::console;
use calibrant::estimate::{ImuCalibration, Validation};
use calibrant::io::{ImuFile, Input, imu_calibration_json, write_atomically, write_imu_calibration};
use calibrant::noise::SensorNoise;
use calibrant::report::{About, imu_calibration_report, number_format};
use rayon::prelude::*;
use std::path::Path;

/// An IMU that is calibrated.
pub(super) struct Done {
    pub(super) calibration: ImuCalibration,
    pub(super) validations: Vec<Validation>,
    pub(super) file: ImuFile,
    pub(super) inputs: Vec<Input>,
}

/// Writes calibration.json and report.html.
pub(super) fn write(
    arguments: &Arguments,
    directory: &Path,
    Done { calibration, validations, file, inputs }: &Done,
    noise: Vec<SensorNoise>,
) -> calibrant::Result<()> {
    let json = directory.join("calibration.json");
    let json = || write_imu_calibration(&json, calibration, validations, inputs, &arguments.rules.words());
    if arguments.no_report {
        super::earlier::warn_of_earlier_report(directory);
        return json();
    }
    let of_inputs = |of: &dyn Fn(&Input) -> String| inputs.iter().map(of).collect::<Vec<_>>().join(" and ");
    let files = of_inputs(&|input| input.file.clone());
    let samples = |input: &Input| {
        format!(
            "{} at {} Hz",
            number_format::count(input.samples),
            number_format::significant(input.rate_hz, 5)
        )
    };
    let about = About {
        title: format!("Calibration of an IMU from {files}"),
        facts: vec![
            ("Recording".into(), files),
            ("Format".into(), file.format.name().into()),
            ("SHA-256".into(), of_inputs(&|input| input.sha256.clone())),
            ("Samples".into(), of_inputs(&samples)),
            ("Experiment".into(), arguments.experiment.display().to_string()),
        ],
        findings: file.findings.iter().map(ToString::to_string).collect(),
        validations: validations.clone(),
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    };
    let physical = |noise: SensorNoise| physical(noise, calibration, &file.recording);
    let noise = noise.into_par_iter().map(physical).collect::<calibrant::Result<Vec<_>>>()?;
    let report = || {
        let html = imu_calibration_report(calibration, &file.recording, &noise, &about);
        write_atomically(&directory.join("report.html"), |out| out.write_all(html.as_bytes()))
    };
    let (json, report) = rayon::join(json, report);
    json.and(report)
}

/// Prints the tables, or calibration.json.
pub(super) fn show(arguments: &Arguments, Done { calibration, validations, inputs, .. }: &Done) {
    if arguments.json {
        return console::print(&imu_calibration_json(
            calibration,
            validations,
            inputs,
            &arguments.rules.words(),
        ));
    }
    console::print(&console::imu_calibration(calibration, validations));
    console::print(&format!("\n{}\n", arguments.main_result().display()));
}
