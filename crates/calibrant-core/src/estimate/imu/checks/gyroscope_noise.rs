//! The gyroscope's noise, where the datasheet gives it.

use crate::estimate::datasheet::noise_not_as_given;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::SensorKind;

/// Does it scatter by much more or less in the holds?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (scatter, given) = (&evidence.gyroscope.scatter, &evidence.problem.gyroscope.noise);
    let differs = |given| noise_not_as_given(SensorKind::Gyroscope, scatter, given);
    given.as_ref().and_then(differs).into_iter().collect()
}
