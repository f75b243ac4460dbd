//! The clock of a simulated recording: when its samples are taken, on both clocks.

use super::recording::normal;
use super::{Rng, sample_times};
use crate::motion::{JerkControlledMotion, MotionClock};
use crate::sensor::Recording;
use schemars::JsonSchema;
use serde::Serialize;

/// The recorder runs this number of standard deviations of the delay before the motion and after it.
const LEAD: f64 = 3.0;

/// The clock as it is, where it was only given with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TrueClock {
    /// Delay at the middle of the motion: motion time less recording time, s.
    pub delay_s: f64,
    /// Rate between the clocks, ppm.
    pub rate_ppm: f64,
}

/// When the samples of a recording are taken.
#[derive(Debug, Clone, PartialEq)]
pub struct ClockedTimes {
    recording_s: Vec<f64>,
    /// The times on the clock of the motion, s.
    pub motion_s: Vec<f64>,
    /// The clock that was drawn; `None` where it is exact.
    pub clock: Option<TrueClock>,
}

impl ClockedTimes {
    /// Draws delay and rate. The recording then covers the motion wherever it begins. An exact clock draws nothing.
    #[must_use]
    pub fn draw(motion: &JerkControlledMotion, rate_hz: f64, given: &MotionClock, rng: &mut Rng) -> Self {
        let mut motion_s = sample_times(motion, rate_hz);
        if given.is_exact() {
            let recording_s = motion_s.iter().map(|time| time - given.delay_s).collect();
            return Self { recording_s, motion_s, clock: None };
        }
        let (start, end) = (motion.times_s()[0], motion.times_s()[motion.intervals()]);
        let delay_s = given.delay_s + given.delay_sd_s * normal(rng);
        let rate = given.rate_sd * normal(rng);
        let middle_s = 0.5 * (start + end) - delay_s;
        let lead = (LEAD * given.delay_sd_s * rate_hz).ceil();
        let first = start - given.delay_s - lead / rate_hz;
        let samples = motion_s.len() + 2 * lead as usize;
        let recording_s: Vec<f64> = (0..samples).map(|k| first + k as f64 / rate_hz).collect();
        motion_s = recording_s.iter().map(|time| time + delay_s + rate * (time - middle_s)).collect();
        Self { recording_s, motion_s, clock: Some(TrueClock { delay_s, rate_ppm: 1e6 * rate }) }
    }

    /// A recording at the times of the motion, on the clock of the recorder.
    #[must_use]
    pub fn on_own_clock(self, recording: Recording) -> Recording {
        Recording { times_s: self.recording_s, ..recording }
    }
}
