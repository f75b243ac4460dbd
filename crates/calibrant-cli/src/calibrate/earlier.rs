//! Results of an earlier run beside those of this one.

use crate::console;
use std::path::Path;

/// A warning where a report is there that is not of the calibration beside it.
pub(super) fn earlier_report(directory: &Path) -> Option<String> {
    earlier(&directory.join("report.html"), "calibration: --no-report writes none")
}

/// What is left of an earlier run is not the result of one that failed.
pub(super) fn warn_of_earlier_result(directory: &Path) {
    let words = earlier(&directory.join("calibration.json"), "recording: this one has none");
    words.iter().for_each(|words| console::warn(words));
}

fn earlier(file: &Path, what: &str) -> Option<String> {
    file.exists().then(|| format!("{} is that of an earlier {what}", file.display()))
}
