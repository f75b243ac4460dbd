//! What a log of a machine's motion contains.

use super::output::Output;
use crate::diagnostics::judge;
use crate::exit::Exit;
use calibrant::inspection::log_sheet;
use calibrant::io::{
    ImuReadOptions, ReferenceInspectionFile, ReferenceLogOptions, file_name, inspect_reference_log,
    is_reference_log, read_reference_log, to_json,
};
use std::path::Path;

/// Is a file, which is no recording, a log of a motion? Not where it is said to be a recording.
pub(super) fn is_one(path: &Path, options: &ImuReadOptions) -> bool {
    options.format.is_none() && options.columns.is_empty() && is_reference_log(path, &of_log(options))
}

/// Prints what a log contains.
pub(super) fn run(path: &Path, options: &ImuReadOptions, output: &Output) -> calibrant::Result<Exit> {
    let mut file = read_reference_log(path, &of_log(options))?;
    file.findings = file.findings.into_iter().map(|found| found.in_file(file_name(path))).collect();
    judge(&mut file.findings, output.json);
    let inspection = inspect_reference_log(&file);
    let found = ReferenceInspectionFile { file: &file, inspection: &inspection };
    let name = path.display().to_string();
    output.show(|| to_json(&found), &log_sheet(&file, &inspection, &name))?;
    Ok(Exit::DONE)
}

/// The options that a log has of those of a recording.
fn of_log(options: &ImuReadOptions) -> ReferenceLogOptions {
    ReferenceLogOptions { time_unit: options.time_unit, topic: options.topic.clone(), ..Default::default() }
}
