//! A thermometer that lags the sensor, or shows its temperature in coarse steps.

use crate::diagnostic::samples::{ThermometerCoarse, ThermometerLags};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::Temperatures;

/// Steps are coarse from here on, K: some sensors report whole degrees.
const COARSE_K: f64 = 0.5;

/// By the recording alone: a lag beyond what is stated, and the steps of the temperature where something follows it.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let seen = evidence.lag.and_then(|lag| lag.seen);
    let lags = seen.map(|seen| ThermometerLags { lag_s: seen.lag_s, sd_s: seen.sd_s }.into());
    let follows = !evidence.problem.setup.thermal.is_none();
    let shown = Temperatures::of(evidence.problem.recording).ok().flatten().filter(|_| follows);
    let step_k = shown.and_then(|shown| shown.step_k()).filter(|step_k| *step_k >= COARSE_K);
    let coarse = step_k.map(|step_k| ThermometerCoarse { step_k }.into());
    lags.into_iter().chain(coarse).collect()
}
