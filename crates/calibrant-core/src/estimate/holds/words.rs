//! What is said of an accelerometer in holds.

use crate::estimate::CoarseAxis;
use crate::sensor::Recording;

/// Says which axes of an accelerometer come in coarse steps.
pub(in crate::estimate) fn coarse_words(coarse: &[CoarseAxis], recording: &Recording) -> Vec<String> {
    let help = "choose a smaller range, or more digits in the file";
    let words = |found: &CoarseAxis| found.words("accelerometer", recording.unit.symbol());
    coarse.iter().map(|found| format!("{}; {help}", words(found))).collect()
}
