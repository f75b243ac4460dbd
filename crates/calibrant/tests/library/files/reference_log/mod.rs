//! Tests of logs of a machine's motion: each format written and read back, and broken ones.

mod bags;
mod broken;
mod formats;
mod joint_order;
mod real;

use calibrant::io::{ReferenceLogFile, ReferenceLogOptions, TimeUnit, parse_reference_log};

fn read(text: &str) -> ReferenceLogFile {
    parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn in_unit(unit: TimeUnit) -> ReferenceLogOptions {
    ReferenceLogOptions { time_unit: Some(unit), ..ReferenceLogOptions::default() }
}

fn findings(file: &ReferenceLogFile) -> Vec<String> {
    file.findings.iter().map(ToString::to_string).collect()
}
