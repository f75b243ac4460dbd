//! Reads `[motion]`: a commanded motion, its intervals and how far it is trusted.

use super::motion_gravity;
use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::motion::{
    CommandedMotion, InputNoise, JerkControlledMotion, KnownEnds, MotionGravity, Trust,
};
use calibrant_core::sensor::Sensor;
use nalgebra::Vector3;

/// Range of a sample rate.
pub(super) const RATE_HZ: Bounds = Bounds::above(0.0, 1e6, "Hz");
/// Range of the duration of an interval.
const INTERVAL_S: Bounds = Bounds::above(0.0, 1e6, "s");
/// Range of the constant part of the process noise.
const FLOOR_MPS3: Bounds = Bounds::from(0.0, 1e9, "m/s³");
/// Range of the process noise relative to the jerk.
const RATIO: Bounds = Bounds::from(0.0, 1e3, "");

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
}

impl MotionPlan {
    /// The command of this motion.
    #[must_use]
    pub fn command(&self, motion: JerkControlledMotion) -> CommandedMotion {
        CommandedMotion { motion, trust: self.trust, known_ends: self.known_ends, gravity: self.gravity }
    }

    /// The range of a sensor, less what gravity takes of it.
    #[must_use]
    pub fn range_left(&self, sensor: &Sensor) -> Option<Vector3<f64>> {
        let range = sensor.range_mps2?;
        Some(self.gravity.map_or(range, |gravity| gravity.range_left(&range)))
    }
}

/// Reads `[motion]`.
pub(super) fn read(section: &Section<'_>, sensor: &Sensor) -> Result<MotionPlan> {
    let (intervals, interval_s, rate_hz) = read_grid(section, None)?;
    let (trust, known_ends) = read_trust(section)?;
    let gravity = motion_gravity::read(section, sensor)?;
    Ok(MotionPlan { intervals, interval_s, rate_hz, trust, known_ends, gravity })
}

/// Reads intervals, their duration and the sample rate. A section that varies another takes its missing keys
/// from there.
pub(super) fn read_grid(section: &Section<'_>, base: Option<&MotionPlan>) -> Result<(usize, f64, f64)> {
    let given = |key: &str, help: &str| match base {
        Some(_) => Ok(section.get(key)),
        None => section.need(key, help).map(Some),
    };
    let intervals = match (given("intervals", "the number of intervals, for example intervals = 10")?, base) {
        (None, Some(base)) => base.intervals,
        (entry, _) => entry.map_or(Ok(1), |entry| entry.size(1, 10_000_000))?,
    };
    let help = "the duration of an interval in seconds, for example interval_s = 1.0";
    let interval_s = match (given("interval_s", help)?, base) {
        (None, Some(base)) => base.interval_s,
        (entry, _) => entry.map_or(Ok(1.0), |entry| entry.number(&INTERVAL_S))?,
    };
    let rate = given("rate_hz", "the sample rate in Hz, for example rate_hz = 10.0")?;
    let rate_hz = match (&rate, base) {
        (None, Some(base)) => base.rate_hz,
        (entry, _) => entry.as_ref().map_or(Ok(1.0), |entry| entry.number(&RATE_HZ))?,
    };
    check_samples(section, "rate_hz", intervals as f64 * interval_s, rate_hz)?;
    Ok((intervals, interval_s, rate_hz))
}

/// Returns an error for a rate, under this key, at which a motion has no samples.
pub(super) fn check_samples(section: &Section<'_>, key: &str, duration_s: f64, rate_hz: f64) -> Result<()> {
    let reject = |message: String, help: String| match section.get(key) {
        Some(entry) => entry.reject(message, help),
        None => section.reject(&message, &help, key),
    };
    let samples = duration_s * rate_hz;
    // a little tolerance: 10 × 0.1 s × 1 Hz is one sample step, whatever the rounding
    if samples < 1.0 - 1e-9 {
        return Err(reject(
            format!("the motion lasts {duration_s} s, less than one sample step of {} s", 1.0 / rate_hz),
            "raise the rate, or lengthen the motion".into(),
        ));
    }
    Ok(())
}

#[derive(Clone, Copy)]
enum Word {
    Known,
    Noisy,
    Unknown,
}

fn read_trust(section: &Section<'_>) -> Result<(Trust, KnownEnds)> {
    let word = section
        .need("trust", "how far the motion is trusted: \"known\", \"noisy\" or \"unknown\"")?
        .word(&[("known", Word::Known), ("noisy", Word::Noisy), ("unknown", Word::Unknown)])?;
    // read and checked whatever the trust: an experiment changes its trust by one word
    let noise = read_noise(section, "motion.input_noise")?;
    let ends = section.get("known_ends");
    let known_ends = match &ends {
        Some(entry) => Some(entry.word(&[("start", KnownEnds::Start), ("both", KnownEnds::Both)])?),
        None => None,
    };
    match word {
        Word::Known => Ok((Trust::Known, known_ends.unwrap_or(KnownEnds::Start))),
        Word::Noisy => {
            let noise = noise.ok_or_else(|| {
                section.missing(
                    "input_noise",
                    "trust \"noisy\" needs it: input_noise = { floor_mps3 = 0.01, ratio = 0.01 }",
                )
            })?;
            Ok((Trust::Noisy(noise), known_ends.unwrap_or(KnownEnds::Start)))
        }
        Word::Unknown => match (ends, known_ends) {
            (Some(entry), Some(KnownEnds::Start)) => Err(entry.reject(
                "trust \"unknown\" needs the acceleration at both ends of the motion",
                "known_ends = \"both\", or leave the key away",
            )),
            _ => Ok((Trust::Unknown, KnownEnds::Both)),
        },
    }
}

/// Reads the process noise, where it is given; `name` is the full name of its section.
pub(super) fn read_noise(section: &Section<'_>, name: &'static str) -> Result<Option<InputNoise>> {
    section
        .section(name)?
        .map(|table| {
            let floor = table.need("floor_mps3", "the noise at any jerk, m/s³")?.number(&FLOOR_MPS3)?;
            let ratio =
                table.need("ratio", "the noise relative to the jerk; 0.01 is one percent")?.number(&RATIO)?;
            Ok(InputNoise { floor_mps3: floor, ratio })
        })
        .transpose()
}
