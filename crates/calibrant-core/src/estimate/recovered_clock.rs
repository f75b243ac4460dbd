//! The clock of a recording beside that of its motion, as it was estimated with the parameters.

use crate::motion::MotionClock;
use crate::sensor::Recording;
use std::borrow::Cow;

/// The clock of a recording: `τ = t + δ + ε (t − t_m)`, with motion time τ and recording time t.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RecoveredClock {
    /// What was known of it.
    pub given: MotionClock,
    /// Delay δ, s.
    pub delay_s: f64,
    /// Its standard deviation, s; 0 where it was given as exact.
    pub delay_sd_s: f64,
    /// Rate ε, relative.
    pub rate: f64,
    /// Its standard deviation; 0 where it was given as exact.
    pub rate_sd: f64,
    /// The recording's time t_m at which the delay is stated: the middle of the motion, s.
    pub at_s: f64,
}

impl RecoveredClock {
    /// The time of the motion at a time of the recording, s.
    #[must_use]
    pub fn motion_time_s(&self, time_s: f64) -> f64 {
        time_s + self.delay_s + self.rate * (time_s - self.at_s)
    }

    /// A recording on the clock of the motion.
    #[must_use]
    pub fn on_motion_clock<'a>(&self, recording: &'a Recording) -> Cow<'a, Recording> {
        if self.delay_s == 0.0 && self.rate == 0.0 {
            return Cow::Borrowed(recording);
        }
        let times_s = recording.times_s.iter().map(|time| self.motion_time_s(*time)).collect();
        Cow::Owned(Recording { times_s, ..recording.clone() })
    }
}
