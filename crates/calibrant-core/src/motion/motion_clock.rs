//! The clock of a recording beside that of its commanded motion (`[motion.clock]`). Plain data: no estimation here.

/// What is known of the clock of a recording beforehand: motion time = recording time + delay, and the rate between both clocks.
///
/// `τ = t + δ + ε (t − t_m)`, with `δ ~ N(delay_s, delay_sd_s²)`, `ε ~ N(0, rate_sd²)` and the middle `t_m` of the motion.
/// The default is an exact clock without delay: the thesis's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionClock {
    /// Expected delay, s: motion time less recording time.
    pub delay_s: f64,
    /// Its standard deviation, s; 0 where it is exact.
    pub delay_sd_s: f64,
    /// Standard deviation of the rate between the two clocks, relative; 0 where they are one.
    pub rate_sd: f64,
}

impl MotionClock {
    /// Are delay and rate known exactly?
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.delay_sd_s == 0.0 && self.rate_sd == 0.0
    }
}
