//! A thermometer that lags the sensor.

use crate::diagnostic::samples::ThermometerLags;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// By the recording alone, without what was supposed of the lag.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let seen = evidence.lag.filter(|lag| lag.is_seen);
    seen.map(|of| ThermometerLags { lag_s: of.lag.lag_s, sd_s: of.lag.sd_s }.into()).into_iter().collect()
}
