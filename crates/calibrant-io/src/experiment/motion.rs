//! `[motion]`: a commanded motion, its intervals and how far it is trusted.

use super::direction::Direction;
use super::number::{Count, PerAxis, Within};
use super::ranges::{
    Delay, DelaySd, Duration, GravityComponent, GravitySd, Height, JerkNoise, JerkRatio, Latitude, Rate,
    RateSd, SmallTilt,
};
use super::refused_key::{missing, refused};
use calibrant_core::error::Result;
use calibrant_core::motion::{
    CommandedMotion, InputNoise, JerkControlledMotion, KnownEnds, MotionClock, MotionGravity, Trust,
};
use calibrant_core::sensor::Sensor;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// A number of intervals.
pub type Intervals = Count<1, 10_000_000>;

/// `[motion]`: a commanded motion whose acceleration is linear within each interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionSection {
    /// Number of intervals N.
    pub intervals: Intervals,
    /// Duration of an interval Δτ.
    pub interval_s: Within<Duration>,
    /// Sample rate f_s.
    pub rate_hz: Within<Rate>,
    /// How far the motion is trusted.
    pub trust: MotionTrust,
    /// Which ends have a known acceleration; the start without it, both where the motion is unknown.
    pub known_ends: Option<KnownEnds>,
    /// Process noise on the jerk, which `trust` may ask for.
    pub input_noise: Option<InputNoiseSection>,
    /// The direction up, where `gravity_mps2` is a magnitude or latitude and height give it.
    pub gravity: Option<Direction>,
    /// The specific force at rest in the sensor's axes, or its magnitude.
    pub gravity_mps2: Option<PerAxis<GravityComponent>>,
    /// Standard uncertainty of gravity.
    pub gravity_sd_mps2: Option<Within<GravitySd>>,
    /// Geographic latitude.
    pub latitude_deg: Option<Within<Latitude>>,
    /// Height above the sea.
    pub height_m: Option<Within<Height>>,
    /// Standard deviation of the arm's tilt about each axis.
    pub tilt_sd_deg: Option<Within<SmallTilt>>,
    /// The clock of the recording beside that of the motion; without it both begin together.
    pub clock: Option<MotionClockSection>,
}

/// `[motion.clock]`: motion time = recording time + delay.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionClockSection {
    /// Expected delay.
    pub delay_s: Option<Within<Delay>>,
    /// Its standard deviation.
    pub delay_sd_s: Option<Within<DelaySd>>,
    /// Standard deviation of the rate between the two clocks.
    pub rate_sd_ppm: Option<Within<RateSd>>,
}

impl From<MotionClockSection> for MotionClock {
    fn from(section: MotionClockSection) -> Self {
        let usual = Self { delay_s: 0.0, delay_sd_s: 2.0, rate_sd: 1e-4 };
        Self {
            delay_s: section.delay_s.map_or(usual.delay_s, f64::from),
            delay_sd_s: section.delay_sd_s.map_or(usual.delay_sd_s, f64::from),
            rate_sd: section.rate_sd_ppm.map_or(usual.rate_sd, |rate| rate.get() / 1e6),
        }
    }
}

/// How far a commanded motion is trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MotionTrust {
    /// It is exact.
    Known,
    /// It has process noise.
    Noisy,
    /// Only its ends are known.
    Unknown,
}

/// The process noise on the jerk: its standard deviation is floor + ratio |u|.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputNoiseSection {
    /// Noise at any jerk.
    pub floor_mps3: Within<JerkNoise>,
    /// Noise relative to the jerk.
    pub ratio: Within<JerkRatio>,
}

impl From<InputNoiseSection> for InputNoise {
    fn from(section: InputNoiseSection) -> Self {
        Self { floor_mps3: section.floor_mps3.get(), ratio: section.ratio.get() }
    }
}

/// A commanded motion of equal intervals, as `[motion]` describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionPlan {
    /// Number of intervals N.
    pub intervals: usize,
    /// Duration of an interval Δτ, s.
    pub interval_s: f64,
    /// Sample rate f_s, Hz.
    pub rate_hz: f64,
    /// How far the motion is trusted.
    pub trust: Trust,
    /// Which ends have a known acceleration.
    pub known_ends: KnownEnds,
    /// Gravity in the sensor's axes, where it is given.
    pub gravity: Option<MotionGravity>,
    /// The clock of the recording beside that of the motion.
    pub clock: MotionClock,
}

impl MotionPlan {
    /// The command of this motion.
    #[must_use]
    pub fn command(&self, motion: JerkControlledMotion) -> CommandedMotion {
        let Self { trust, known_ends, gravity, clock, .. } = *self;
        CommandedMotion { motion, trust, known_ends, gravity, clock }
    }

    /// The range of a sensor, less what gravity takes of it.
    #[must_use]
    pub fn range_left(&self, sensor: &Sensor) -> Option<Vector3<f64>> {
        let range = sensor.range_mps2?;
        Some(self.gravity.map_or(range, |gravity| gravity.range_left(&range)))
    }

    /// The same motion with these numbers in place of its own.
    pub(super) fn with_grid(
        &self,
        intervals: Option<Intervals>,
        interval_s: Option<Within<Duration>>,
        rate_hz: Option<Within<Rate>>,
    ) -> Self {
        Self {
            intervals: intervals.map_or(self.intervals, Count::size),
            interval_s: interval_s.map_or(self.interval_s, f64::from),
            rate_hz: rate_hz.map_or(self.rate_hz, f64::from),
            ..self.clone()
        }
    }

    /// Returns an error about this key for a rate at which the motion has no samples.
    pub(super) fn check_samples(&self, key: &str, rate_hz: f64) -> Result<()> {
        let duration_s = self.intervals as f64 * self.interval_s;
        // a little tolerance: 10 × 0.1 s × 1 Hz is one sample step, whatever the rounding
        if duration_s * rate_hz < 1.0 - 1e-9 {
            let message =
                format!("the motion lasts {duration_s} s, less than one sample step of {} s", 1.0 / rate_hz);
            return Err(refused(key, message, "raise the rate, or lengthen the motion"));
        }
        Ok(())
    }
}

impl MotionSection {
    /// The plan of such a motion.
    pub(super) fn plan(&self, sensor: &Sensor) -> Result<MotionPlan> {
        let (trust, known_ends) = self.trust()?;
        let clock = self.clock.map_or_else(MotionClock::default, MotionClock::from);
        if trust == Trust::Unknown && !clock.is_exact() {
            return Err(refused(
                "motion.clock",
                "trust \"unknown\" has no motion in which a delay could be found",
                "leave [motion.clock] away, or set delay_sd_s = 0.0 and rate_sd_ppm = 0.0 in it",
            ));
        }
        let plan = MotionPlan {
            intervals: self.intervals.size(),
            interval_s: self.interval_s.get(),
            rate_hz: self.rate_hz.get(),
            trust,
            known_ends,
            gravity: self.gravity_of(sensor)?,
            clock,
        };
        plan.check_samples("motion.rate_hz", plan.rate_hz)?;
        Ok(plan)
    }

    fn trust(&self) -> Result<(Trust, KnownEnds)> {
        let ends = self.known_ends.unwrap_or(KnownEnds::Start);
        match (self.trust, self.input_noise) {
            (MotionTrust::Known, _) => Ok((Trust::Known, ends)),
            (MotionTrust::Noisy, Some(noise)) => Ok((Trust::Noisy(noise.into()), ends)),
            (MotionTrust::Noisy, None) => Err(missing(
                "motion.input_noise",
                "trust \"noisy\" needs it: input_noise = { floor_mps3 = 0.01, ratio = 0.01 }",
            )),
            (MotionTrust::Unknown, _) if self.known_ends == Some(KnownEnds::Start) => Err(refused(
                "motion.known_ends",
                "trust \"unknown\" needs the acceleration at both ends of the motion",
                "known_ends = \"both\", or leave the key away",
            )),
            (MotionTrust::Unknown, _) => Ok((Trust::Unknown, KnownEnds::Both)),
        }
    }
}
