//! `[study]`: which studies over many sensors are run.

use super::Plan;
use super::limits::section_with_limits;
use super::motion::{InputNoiseSection, Intervals, MotionPlan};
use super::number::{Count, PerAxis, Within, size, whole};
use super::ranges::{Acceleration, Displacement, Duration, Jerk, Rate, SignedAcceleration, Velocity};
use super::refused_key::{missing, refused};
use super::sensor::per_axis;
use calibrant_core::error::Result;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, Rest, Trust};
use calibrant_design::SurfaceSettings;
use serde::{Deserialize, Serialize};

/// Largest number of sensors.
const MOST: u64 = 10_000_000;

/// `[study]`: which studies over many sensors are run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StudyOptions {
    /// Number of simulated sensors.
    #[serde(deserialize_with = "size::<1, MOST, _>")]
    pub sensors: usize,
    /// Seed of everything random.
    #[serde(deserialize_with = "whole")]
    pub seed: u64,
    /// Number of the optimal motions that are shown together.
    #[serde(deserialize_with = "size::<1, MOST, _>")]
    pub motions: usize,
    /// Starts of each sensor's design; without it, as `[design]` says.
    pub starts: Option<Count<1, 1_000_000>>,
    /// The criterion over the jerks of two intervals.
    pub surface: Option<SurfaceSection>,
    /// A calibration without knowledge of the motion.
    pub unknown: Option<UnknownSection>,
    /// The experiment of `[motion]` with process noise.
    pub noisy: Option<NoisySection>,
}

impl Default for StudyOptions {
    fn default() -> Self {
        Self { sensors: 30, seed: 1, motions: 10, starts: None, surface: None, unknown: None, noisy: None }
    }
}

/// `[study.surface]`: one axis, two intervals, the motion known.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSection {
    /// Largest jerk.
    pub jerk_mps3: Option<Within<Jerk>>,
    /// Number of jerks in each direction.
    pub points: Option<Count<2, 1001>>,
    /// Acceleration at the start.
    pub start_acceleration_mps2: Option<Within<SignedAcceleration>>,
    /// Duration of an interval; without it, that of `[motion]`.
    pub interval_s: Option<Within<Duration>>,
    /// Sample rate; without it, that of `[motion]`.
    pub rate_hz: Option<Within<Rate>>,
}

section_with_limits! {
    /// `[study.unknown]`: what is not there is as in `[motion]`; its limits replace all of `[limits]`.
    pub struct UnknownSection {
        /// Number of simulated sensors.
        pub sensors: Option<Count<1, MOST>>,
        /// Number of intervals.
        pub intervals: Option<Intervals>,
        /// Duration of an interval.
        pub interval_s: Option<Within<Duration>>,
        /// Sample rate.
        pub rate_hz: Option<Within<Rate>>,
        /// Rate at which one of the sensors is recorded once more.
        pub detail_rate_hz: Option<Within<Rate>>,
    }
}

section_with_limits! {
    /// `[study.noisy]`: its limits replace all of `[limits]`.
    pub struct NoisySection {
        /// Process noise; without it, that of `[motion]`.
        pub input_noise: Option<InputNoiseSection>,
    }
}

/// A calibration without knowledge of the motion. Keys that the section does not have are as in `[motion]`.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownVariant {
    /// Number of simulated sensors.
    pub sensors: usize,
    /// The motion.
    pub plan: MotionPlan,
    /// Rate at which one of the sensors is recorded once more, Hz.
    pub detail_rate_hz: Option<f64>,
    /// Limits in place of `[limits]`.
    pub limits: Option<Limits>,
}

/// The experiment of `[motion]` with process noise.
#[derive(Debug, Clone, PartialEq)]
pub struct NoisyVariant {
    /// The process noise.
    pub noise: InputNoise,
    /// Limits in place of `[limits]`.
    pub limits: Option<Limits>,
}

impl StudyOptions {
    /// The surface of the criterion beside this motion, where it is asked for.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where its motion has no samples.
    pub fn surface(&self, base: &MotionPlan) -> Result<Option<SurfaceSettings>> {
        self.surface.as_ref().map(|surface| surface.settings(base)).transpose()
    }

    /// The calibration without knowledge of the motion, where it is asked for, of a sensor with these axes.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where its motion has no samples, or a limit not one number for each axis.
    pub fn unknown(&self, base: &MotionPlan, axes: usize) -> Result<Option<UnknownVariant>> {
        self.unknown.as_ref().map(|unknown| unknown.variant(base, self.sensors, axes)).transpose()
    }

    /// The experiment with process noise, where it is asked for, of a sensor with these axes.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) without process noise, or where a limit is not one number for each axis.
    pub fn noisy(&self, base: &MotionPlan, axes: usize) -> Result<Option<NoisyVariant>> {
        self.noisy.as_ref().map(|noisy| noisy.variant(base, axes)).transpose()
    }

    /// Refuses keys that contradict each other, or this plan.
    pub(super) fn check(&self, plan: &Plan, axes: usize) -> Result<()> {
        if let Plan::Motion(plan) = plan {
            self.surface(plan)?;
            self.unknown(plan, axes)?;
            return self.noisy(plan, axes).map(drop);
        }
        let variants = [
            ("study.surface", self.surface.is_some()),
            ("study.unknown", self.unknown.is_some()),
            ("study.noisy", self.noisy.is_some()),
        ];
        match variants.iter().find(|(_, is_there)| *is_there) {
            Some((key, _)) => {
                Err(refused(*key, "this needs a [motion]", "take it out, or describe a motion"))
            }
            None => Ok(()),
        }
    }
}

impl SurfaceSection {
    fn settings(&self, base: &MotionPlan) -> Result<SurfaceSettings> {
        let plan = MotionPlan { intervals: 2, ..base.with_grid(None, self.interval_s, self.rate_hz) };
        plan.check_samples("study.surface.rate_hz", plan.rate_hz)?;
        Ok(SurfaceSettings {
            jerk_mps3: self.jerk_mps3.map_or(0.5, f64::from),
            points: self.points.map_or(41, Count::size),
            start_mps2: self.start_acceleration_mps2.map_or(0.0, f64::from),
            interval_s: plan.interval_s,
            rate_hz: plan.rate_hz,
        })
    }
}

impl UnknownSection {
    fn variant(&self, base: &MotionPlan, sensors: usize, axes: usize) -> Result<UnknownVariant> {
        let (trust, known_ends) = (Trust::Unknown, KnownEnds::Both);
        let plan = base.with_grid(self.intervals, self.interval_s, self.rate_hz);
        plan.check_samples("study.unknown.rate_hz", plan.rate_hz)?;
        let detail_rate_hz = self.detail_rate_hz.map(f64::from);
        if let Some(rate_hz) = detail_rate_hz {
            plan.check_samples("study.unknown.detail_rate_hz", rate_hz)?;
        }
        Ok(UnknownVariant {
            sensors: self.sensors.map_or(sensors, Count::size),
            plan: MotionPlan { trust, known_ends, ..plan },
            detail_rate_hz,
            limits: self.limits("study.unknown", axes)?,
        })
    }
}

impl NoisySection {
    fn variant(&self, base: &MotionPlan, axes: usize) -> Result<NoisyVariant> {
        let noise = match (self.input_noise, base.trust) {
            (Some(noise), _) => noise.into(),
            (None, Trust::Noisy(noise)) => noise,
            (None, Trust::Known | Trust::Unknown) => {
                let help = "write input_noise = { floor_mps3 = 0.01, ratio = 0.01 }";
                return Err(missing("study.noisy.input_noise", help));
            }
        };
        Ok(NoisyVariant { noise, limits: self.limits("study.noisy", axes)? })
    }
}
