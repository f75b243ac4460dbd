//! A thermometer that lags the sensor.

use crate::diagnostic::samples::ThermometerLags;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// By the recording alone, beyond what is stated of the lag.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let seen = evidence.lag.and_then(|lag| lag.seen);
    seen.map(|seen| ThermometerLags { lag_s: seen.lag_s, sd_s: seen.sd_s }.into()).into_iter().collect()
}
