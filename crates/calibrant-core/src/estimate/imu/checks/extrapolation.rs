//! Polynomials of temperature beyond the temperatures of the holds.

use crate::diagnostic::samples::{ReferenceExtrapolated, TemperatureExtrapolated};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::Thermal;

/// By the temperatures of the whole recording.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    extrapolation(&evidence.calibration.imu.thermal, evidence.temperature.of_recording())
}

fn extrapolation(thermal: &Thermal, recording_c: Option<[f64; 2]>) -> Diagnostics {
    let (Some([low, high]), Some([coldest, hottest])) = (thermal.range_c, recording_c) else {
        return Vec::new();
    };
    let beyond = |t: f64| thermal.extrapolates_to(t);
    let mut warnings = Vec::new();
    if beyond(coldest) || beyond(hottest) {
        warnings.push(
            TemperatureExtrapolated {
                coldest_c: coldest,
                hottest_c: hottest,
                holds_coldest_c: low,
                holds_hottest_c: high,
            }
            .into(),
        );
    }
    if beyond(thermal.reference_c) {
        warnings.push(
            ReferenceExtrapolated {
                reference_c: thermal.reference_c,
                holds_coldest_c: low,
                holds_hottest_c: high,
            }
            .into(),
        );
    }
    warnings
}
