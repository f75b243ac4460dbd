//! Polynomials of temperature beyond the temperatures of the holds.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::Thermal;

/// By the temperatures of the whole recording.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    extrapolation(&evidence.calibration.imu.thermal, evidence.temperature.of_recording())
}

fn extrapolation(thermal: &Thermal, recording_c: Option<[f64; 2]>) -> Vec<String> {
    let (Some([low, high]), Some([coldest, hottest])) = (thermal.range_c, recording_c) else {
        return Vec::new();
    };
    let beyond = |t: f64| thermal.extrapolates_to(t);
    let mut warnings = Vec::new();
    if beyond(coldest) || beyond(hottest) {
        warnings.push(format!(
            "the recording goes from {coldest:.1} to {hottest:.1} °C, its holds from {low:.1} to {high:.1} °C only: beyond these the polynomials of temperature extrapolate"
        ));
    }
    if beyond(thermal.reference_c) {
        warnings.push(format!(
            "biases and gains are given at the reference of {:.1} °C, beyond the {low:.1} to {high:.1} °C of the holds: there they are extrapolated",
            thermal.reference_c
        ));
    }
    warnings
}
