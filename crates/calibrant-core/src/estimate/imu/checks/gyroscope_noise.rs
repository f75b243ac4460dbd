//! The gyroscope's noise, where the datasheet gives it.

use crate::diagnostic::Diagnostic;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::problem::NoiseSource;
use crate::sensor::{Axis, SensorKind};

/// The scatter within holds over the noise that was given is no cause for concern in this range.
const USUAL_RATIOS: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// Axes that scatter by much more or less in the holds.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    if evidence.gyroscope.noise_source != NoiseSource::Datasheet {
        return Vec::new();
    }
    let (scatter, noise) = (&evidence.gyroscope.scatter, &evidence.model.gyroscope_noise.of_sample);
    let unlike = |axis: Axis| {
        let ratio = scatter[axis.index()] / noise[axis.index()];
        let sensor_kind = SensorKind::Gyroscope;
        let unlike = Diagnostic::NoiseNotAsGiven { sensor_kind, axis, ratio };
        (!USUAL_RATIOS.contains(&ratio)).then_some(unlike)
    };
    Axis::ALL.into_iter().filter_map(unlike).collect()
}
