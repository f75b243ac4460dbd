//! Time offset and clock skew: does the gyroscope show movements later than the accelerometer?
//!
//! `clock` finds them.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::gyroscope::{ClockSkew, TimeOffset};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::clock::ClockDifference;
use crate::sensor::{Recording, SensorKind};

/// An offset of fewer sample intervals does not matter.
const SHORT_INTERVALS: f64 = 1.5;

/// A shorter offset does not matter, s.
const SHORT_S: f64 = 0.005;

/// The offset or the skew, where it is certain and matters.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let recording = evidence.problem.recording;
    let (Some(accelerometer), Some(gyroscope)) =
        (&recording[SensorKind::Accelerometer], &recording[SensorKind::Gyroscope])
    else {
        return Vec::new();
    };
    let found = evidence.clock.as_ref().and_then(|clock| of_clock(clock, accelerometer, gyroscope));
    found.into_iter().collect()
}

/// What a user should know of it, where it is certain and matters.
pub(crate) fn of_clock(
    clock: &ClockDifference,
    accelerometer: &Recording,
    gyroscope: &Recording,
) -> Option<Diagnostic> {
    let (first, last) = (*gyroscope.times_s.first()?, *gyroscope.times_s.last()?);
    if clock.rate().is_some() {
        return Some(Diagnostic::from(ClockSkew {
            first_offset_s: clock.at(first),
            last_offset_s: clock.at(last),
            skew: clock.skew,
            skew_sd: clock.skew_sd,
        }));
    }
    let step = accelerometer.rate_hz().min(gyroscope.rate_hz()).recip();
    let matters = clock.offset_s.abs() > SHORT_S.max(SHORT_INTERVALS * step);
    let offset = Diagnostic::from(TimeOffset { offset_s: clock.offset_s, offset_sd_s: clock.offset_sd_s });
    (matters && clock.is_certain(clock.offset_s, clock.offset_sd_s)).then_some(offset)
}
