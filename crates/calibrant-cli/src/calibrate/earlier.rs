//! Results of an earlier run beside those of this one.

use crate::console;
use std::path::Path;

/// A report that is not written anew is not that of the calibration beside it.
pub(super) fn warn_of_earlier_report(directory: &Path) {
    warn_of_earlier(&directory.join("report.html"), "calibration: --no-report writes none");
}

/// What is left of an earlier run is not the result of one that failed.
pub(super) fn warn_of_earlier_result(directory: &Path) {
    warn_of_earlier(&directory.join("calibration.json"), "recording: this one has none");
}

fn warn_of_earlier(file: &Path, what: &str) {
    if file.exists() {
        console::warn(&format!("{} is that of an earlier {what}", file.display()));
    }
}
