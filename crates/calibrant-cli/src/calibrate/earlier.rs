//! Files of an earlier run in the output directory.

use crate::console;
use std::path::Path;

/// A warning about a report that belongs to an earlier calibration.
pub(super) fn earlier_report(directory: &Path) -> Option<String> {
    earlier(&directory.join("report.html"), "calibration: --no-report writes none")
}

/// A warning about a calibration of an earlier run, where this run failed.
pub(super) fn warn_of_earlier_result(directory: &Path) {
    let words = earlier(&directory.join("calibration.json"), "recording: this one has none");
    words.iter().for_each(|words| console::warn(words));
}

fn earlier(file: &Path, what: &str) -> Option<String> {
    file.exists().then(|| format!("{} is that of an earlier {what}", file.display()))
}
