//! The gyroscope's noise, where the datasheet gives it.

use crate::estimate::datasheet::noise_not_as_given;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::problem::NoiseSource;
use crate::sensor::SensorKind;

/// Does it scatter by much more or less in the holds?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    if evidence.gyroscope.noise_source != NoiseSource::Datasheet {
        return Vec::new();
    }
    let (scatter, noise) = (&evidence.gyroscope.scatter, &evidence.model.gyroscope_noise.of_sample);
    noise_not_as_given(SensorKind::Gyroscope, scatter, noise).into_iter().collect()
}
