//! Coarse steps of an accelerometer in holds.

use crate::diagnostic::Diagnostic;
use crate::estimate::CoarseAxis;
use crate::sensor::{Recording, SensorKind};

/// The axes of an accelerometer that come in coarse steps.
pub(in crate::estimate) fn coarse_steps(coarse: &[CoarseAxis], recording: &Recording) -> Vec<Diagnostic> {
    coarse.iter().map(|found| found.check(SensorKind::Accelerometer, recording.unit).into()).collect()
}
