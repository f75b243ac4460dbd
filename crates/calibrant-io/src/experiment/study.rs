//! Reads `[study]`: which studies over many sensors are run.

use super::motion::{self, MotionPlan};
use super::number_range::Bounds;
use super::toml_document::Section;
use super::{Plan, limits};
use calibrant_core::error::Result;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, Trust};
use calibrant_design::SurfaceSettings;

/// Range of the largest jerk of the surface.
const JERK: Bounds = Bounds::above(0.0, 1e9, "m/s³");
/// Range of the acceleration at the start.
const ACCELERATION: Bounds = Bounds::from(-1e9, 1e9, "m/s²");
/// Largest number of sensors.
const MOST_SENSORS: u64 = 10_000_000;
/// Largest number of jerks in each direction of the surface.
const MOST_POINTS: u64 = 1001;

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

/// Reads `[study]`.
pub(super) fn read(section: &Section<'_>, plan: &Plan, axes: usize) -> Result<StudyOptions> {
    let otherwise = StudyOptions::default();
    let sensors =
        section.get("sensors").map_or(Ok(otherwise.sensors), |entry| entry.size(1, MOST_SENSORS))?;
    let mut options = StudyOptions {
        sensors,
        seed: section.get("seed").map_or(Ok(otherwise.seed), |entry| entry.whole(0, u64::MAX))?,
        motions: section.get("motions").map_or(Ok(otherwise.motions), |entry| entry.size(1, MOST_SENSORS))?,
        starts: section.get("starts").map(|entry| entry.size(1, 1_000_000)).transpose()?,
        ..otherwise
    };
    let surface = section.section("study.surface")?;
    let unknown = section.section("study.unknown")?;
    let noisy = section.section("study.noisy")?;
    let Plan::Motion(plan) = plan else {
        return match surface.or(unknown).or(noisy) {
            Some(variant) => {
                Err(variant.reject("this needs a [motion]", "take it out, or describe a motion", ""))
            }
            None => Ok(options),
        };
    };
    options.surface = surface.map(|section| read_surface(&section, plan)).transpose()?;
    options.unknown = unknown.map(|section| read_unknown(&section, plan, sensors, axes)).transpose()?;
    options.noisy = noisy.map(|section| read_noisy(&section, plan, axes)).transpose()?;
    Ok(options)
}

fn read_surface(section: &Section<'_>, plan: &MotionPlan) -> Result<SurfaceSettings> {
    let (_, interval_s, rate_hz) =
        motion::read_grid(section, Some(&MotionPlan { intervals: 2, ..plan.clone() }))?;
    Ok(SurfaceSettings {
        jerk_mps3: section.get("jerk_mps3").map_or(Ok(0.5), |entry| entry.number(&JERK))?,
        points: section.get("points").map_or(Ok(41), |entry| entry.size(2, MOST_POINTS))?,
        start_mps2: section
            .get("start_acceleration_mps2")
            .map_or(Ok(0.0), |entry| entry.number(&ACCELERATION))?,
        interval_s,
        rate_hz,
    })
}

fn read_unknown(
    section: &Section<'_>,
    base: &MotionPlan,
    sensors: usize,
    axes: usize,
) -> Result<UnknownVariant> {
    let (intervals, interval_s, rate_hz) = motion::read_grid(section, Some(base))?;
    let detail_rate_hz =
        section.get("detail_rate_hz").map(|entry| entry.number(&motion::RATE_HZ)).transpose()?;
    if let Some(rate_hz) = detail_rate_hz {
        motion::check_samples(section, "detail_rate_hz", intervals as f64 * interval_s, rate_hz)?;
    }
    let (trust, known_ends) = (Trust::Unknown, KnownEnds::Both);
    Ok(UnknownVariant {
        sensors: section.get("sensors").map_or(Ok(sensors), |entry| entry.size(1, MOST_SENSORS))?,
        plan: MotionPlan { intervals, interval_s, rate_hz, trust, known_ends, gravity: base.gravity },
        detail_rate_hz,
        limits: limits::read_instead(section, axes)?,
    })
}

fn read_noisy(section: &Section<'_>, base: &MotionPlan, axes: usize) -> Result<NoisyVariant> {
    let noise = match (motion::read_noise(section, "study.noisy.input_noise")?, base.trust) {
        (Some(noise), _) | (None, Trust::Noisy(noise)) => noise,
        (None, Trust::Known | Trust::Unknown) => {
            let help = "write input_noise = { floor_mps3 = 0.01, ratio = 0.01 }";
            return Err(section.missing("input_noise", help));
        }
    };
    Ok(NoisyVariant { noise, limits: limits::read_instead(section, axes)? })
}
