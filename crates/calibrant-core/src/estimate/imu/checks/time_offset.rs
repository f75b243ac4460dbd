//! Time offset and clock skew: does the gyroscope show movements later than the accelerometer?
//!
//! `clock` finds them.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::clock::difference::ClockDifference;
use crate::sensor::Recording;

/// An offset of fewer sample intervals does not matter.
const SHORT_INTERVALS: f64 = 1.5;

/// A shorter offset does not matter, s.
const SHORT_S: f64 = 0.005;

/// The offset or the skew, where it is certain and matters.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let recording = evidence.problem.recording;
    let (Some(accelerometer), Some(gyroscope)) = (&recording.accelerometer, &recording.gyroscope) else {
        return Vec::new();
    };
    let stated = evidence.clock.as_ref().and_then(|clock| words(clock, accelerometer, gyroscope));
    stated.into_iter().collect()
}

/// What to say of it, where it is certain and matters.
pub(crate) fn words(
    clock: &ClockDifference,
    accelerometer: &Recording,
    gyroscope: &Recording,
) -> Option<String> {
    let (first, last) = (*gyroscope.times_s.first()?, *gyroscope.times_s.last()?);
    if clock.rate().is_some() {
        return Some(format!(
            "the clocks of the two sensors go at different rates: the gyroscope shows movements {} than the accelerometer at the beginning and {} at the end, {:+.4} ± {:.4} % of the time; its \
             gains are too {} by this share if the accelerometer's clock is right: {}",
            late(clock.at(first), 1),
            late(clock.at(last), 1),
            100.0 * clock.skew,
            100.0 * clock.skew_sd,
            if clock.skew > 0.0 { "large" } else { "small" },
            repair(clock.at(first), clock.skew, 3)
        ));
    }
    let step = accelerometer.rate_hz().min(gyroscope.rate_hz()).recip();
    let matters = clock.offset_s.abs() > SHORT_S.max(SHORT_INTERVALS * step);
    (matters && clock.is_certain(clock.offset_s, clock.offset_sd_s)).then(|| {
        format!(
            "the gyroscope shows movements {} than the accelerometer (± {:.1} ms): a latency, or clocks that were set differently; holds and rotations are cut short by it: {}",
            late(clock.offset_s, 1),
            1e3 * clock.offset_sd_s,
            repair(clock.offset_s, 0.0, 4)
        )
    })
}

/// `12.3 ms later`.
pub(crate) fn late(offset_s: f64, digits: usize) -> String {
    format!("{:.digits$} ms {}", 1e3 * offset_s.abs(), if offset_s > 0.0 { "later" } else { "earlier" })
}

/// What puts the gyroscope's times right that are late by this at the first sample and later by `skew` with each second.
pub(crate) fn repair(first_s: f64, skew: f64, digits: usize) -> String {
    let shift = match first_s > 0.0 {
        true => format!("subtract {first_s:.digits$} s from"),
        false => format!("add {:.digits$} s to", -first_s),
    };
    if skew == 0.0 {
        return format!("{shift} the gyroscope's times");
    }
    let factor =
        format!("multiply the time since the gyroscope's first sample by {:.*}", digits + 3, 1.0 - skew);
    let is_little = first_s.abs() < 0.5 * 10.0_f64.powi(-(digits as i32));
    if is_little { factor } else { format!("{factor}, and {shift} its times") }
}
