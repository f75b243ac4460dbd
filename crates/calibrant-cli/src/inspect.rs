//! `calibrant inspect`: shows what a recording contains, and how good a calibration from it can be; or the joints of a machine.

mod machine;
mod output;
mod reference_log;

use crate::diagnostics::judge;
use crate::exit::Exit;
use crate::recording_options::RecordingOptions;
use calibrant::inspection::recording_sheet;
use calibrant::io::{
    InspectionFile, ResultPlaces, file_name, inspect, read_imu_pair, read_imu_recording, to_json,
};
use std::path::{Path, PathBuf};

/// Show what a recording, a log of a machine's motion, or a machine (.urdf) contains, before you calibrate from it.
///
/// Prints the format, the columns with units and use, sampling, gaps, saturation and ranges. Prints the holds, how their directions cover the
/// sphere, and the standard deviations to expect of a calibration of the accelerometer. Of a log of joints or poses it prints what was seen,
/// ranges, jumps, and whether the poses are an interpolation of a slower stream. Of a machine it prints the joints between base and tip with their limits,
/// and what is missing.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The recording: MT Manager, Movella DOT, EuRoC, imucal, CSV, Parquet, a bag of ROS, a log of PX4 or ArduPilot; or the accelerometer's file of a pair. A log of a motion: joints, RTDE, TUM, EuRoC's ground truth, a bag. A machine (.urdf).
    file: PathBuf,
    /// The gyroscope's file of a pair (imu_tk).
    second: Option<PathBuf>,
    /// The gyroscope's file, as `calibrate` and `apply` take it.
    #[arg(long, value_name = "FILE", conflicts_with = "second")]
    gyroscope: Option<PathBuf>,
    #[command(flatten)]
    reading: RecordingOptions,
    /// Experiment file whose [columns] name the columns.
    #[arg(long, value_name = "EXPERIMENT")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    machine: machine::Options,
    #[command(flatten)]
    output: output::Output,
}

impl Arguments {
    /// The gyroscope's file of a pair.
    fn second(&self) -> Option<&Path> {
        self.second.as_deref().or(self.gyroscope.as_deref())
    }
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        ResultPlaces {
            results: self.output.report.iter().cloned().collect(),
            inputs: std::iter::once(self.file.as_path())
                .chain(self.second())
                .map(Path::to_path_buf)
                .collect(),
            ..ResultPlaces::default()
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    if machine::is_machine(&arguments.file) {
        return arguments.machine.inspect(&arguments.file, &arguments.output);
    }
    arguments.machine.refuse_for_recording()?;
    let options = arguments.reading.with_columns(arguments.columns.as_deref())?;
    let file = match arguments.second() {
        Some(second) => read_imu_pair(&arguments.file, second, &options)?,
        None => match read_imu_recording(&arguments.file, &options) {
            Err(_) if reference_log::is_one(&arguments.file, &options) => {
                return reference_log::run(&arguments.file, &options, &arguments.output);
            }
            file => file?,
        },
    };
    let second = arguments.second().map(file_name);
    let of_reader = file.findings_in(&file_name(&arguments.file), second.as_deref());
    let mut inspection = inspect(&file);
    // the same, with the names of their files
    inspection.findings.splice(..of_reader.len(), of_reader);
    judge(&mut inspection.findings, arguments.output.json);
    let paths = std::iter::once(arguments.file.as_path()).chain(arguments.second());
    let names: Vec<String> = paths.map(|path| path.display().to_string()).collect();
    let found = InspectionFile { file: &file, inspection: &inspection };
    arguments.output.show(|| to_json(&found), &recording_sheet(&file, &inspection, &names))?;
    Ok(Exit::DONE)
}
