//! `[study]`: which studies over many sensors are run.

use super::Plan;
use super::limits::section_with_limits;
use super::motion::{InputNoiseSection, Intervals, MotionPlan};
use super::number::{Count, PerAxis, Within};
use super::ranges::{Acceleration, Displacement, Duration, Jerk, Rate, SignedAcceleration, Velocity};
use super::refused_key::{missing, refused};
use super::sensor::per_axis;
use calibrant_core::error::Result;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, Rest, Trust};
use calibrant_design::SurfaceSettings;
use serde::{Deserialize, Serialize};

/// A number of sensors.
type Sensors = Count<1, 10_000_000>;

/// `[study]`: which studies over many sensors are run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudySection {
    /// Number of simulated sensors.
    pub sensors: Option<Sensors>,
    /// Seed of everything random.
    pub seed: Option<Count<0, { u64::MAX }>>,
    /// Number of the optimal motions that are shown together.
    pub motions: Option<Sensors>,
    /// Starts of each sensor's design; without it, as `[design]` says.
    pub starts: Option<Count<1, 1_000_000>>,
    /// The criterion over the jerks of two intervals.
    pub surface: Option<SurfaceSection>,
    /// A calibration without knowledge of the motion.
    pub unknown: Option<UnknownSection>,
    /// The experiment of `[motion]` with process noise.
    pub noisy: Option<NoisySection>,
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
        pub sensors: Option<Sensors>,
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

/// The options of `[study]`.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyOptions {
    /// Number of simulated sensors.
    pub sensors: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// Number of the optimal motions that are shown together.
    pub motions: usize,
    /// Starts of each sensor's design; `None`: as `[design]` says.
    pub starts: Option<usize>,
    /// `[study.surface]`: the criterion over the jerks of two intervals.
    pub surface: Option<SurfaceSettings>,
    /// `[study.unknown]`: a calibration without knowledge of the motion.
    pub unknown: Option<UnknownVariant>,
    /// `[study.noisy]`: the experiment of `[motion]` with process noise.
    pub noisy: Option<NoisyVariant>,
}

impl Default for StudyOptions {
    fn default() -> Self {
        Self { sensors: 30, seed: 1, motions: 10, starts: None, surface: None, unknown: None, noisy: None }
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

impl StudySection {
    /// The options of such a study.
    pub(super) fn options(&self, plan: &Plan, axes: usize) -> Result<StudyOptions> {
        let otherwise = StudyOptions::default();
        let options = StudyOptions {
            sensors: self.sensors.map_or(otherwise.sensors, Count::size),
            seed: self.seed.map_or(otherwise.seed, Count::get),
            motions: self.motions.map_or(otherwise.motions, Count::size),
            starts: self.starts.map(Count::size),
            ..otherwise
        };
        let variants = [
            ("study.surface", self.surface.is_some()),
            ("study.unknown", self.unknown.is_some()),
            ("study.noisy", self.noisy.is_some()),
        ];
        let Plan::Motion(plan) = plan else {
            return match variants.iter().find(|(_, is_there)| *is_there) {
                Some((key, _)) => {
                    Err(refused(*key, "this needs a [motion]", "take it out, or describe a motion"))
                }
                None => Ok(options),
            };
        };
        let sensors = options.sensors;
        Ok(StudyOptions {
            surface: self.surface.as_ref().map(|of| of.settings(plan)).transpose()?,
            unknown: self.unknown.as_ref().map(|of| of.variant(plan, sensors, axes)).transpose()?,
            noisy: self.noisy.as_ref().map(|of| of.variant(plan, axes)).transpose()?,
            ..options
        })
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
