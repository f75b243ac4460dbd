//! Coarse steps of the gyroscope.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::quantisation::CoarseAxis;
use crate::sensor::SensorKind;

/// The axes that have them.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let unit = evidence.problem.gyroscope.unit;
    let steps = |found: &CoarseAxis| found.check(SensorKind::Gyroscope, unit).into();
    evidence.gyroscope.coarse.iter().map(steps).collect()
}
