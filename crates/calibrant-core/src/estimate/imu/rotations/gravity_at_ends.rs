//! Gravity where a rotation begins and ends: a hand turns slowly within a hold, so that the mean over the hold is not gravity at its ends.
//!
//! The mean of the samples about an end differs from the mean over the hold by `d`, across gravity. Its variance from noise is `v = σ²(1/m − 1/n)`, with m
//! samples about the end and n in the hold. Turns within holds add a variance `τ²`, from the median over all ends, and `d τ²/(τ² + v)` is the difference that counts.
//! Where the sensor is set down, `τ` is zero and nothing is added.
//!
//! The gyroscope's mean rates in the holds then differ by these turns, and not by a bias that wanders.

use crate::estimate::holds::{ROUNDED_TIME_STEPS, median};
use crate::motion::Hold;
use crate::sensor::{Correction, Recording, SensorParameters};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::LN_2;

/// A rotation begins this time before the end of a hold, s. A hand begins so gently that the first milliradians look stationary.
pub(crate) const MARGIN_S: f64 = 0.3;

/// Turns count where noise explains them in no more than so many standard deviations.
const SIGNIFICANT: f64 = 5.0;

/// The specific force at the begin and at the end of a hold less its mean, m/s².
pub(crate) type AtEnds = [Vector3<f64>; 2];

/// How much the sensor turns within holds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::estimate) struct TurnsInHolds {
    /// Variance `τ²` of the specific force at an end, on an axis across gravity, (m/s²)².
    at_ends: f64,
    /// Standard deviation of the mean rate of a hold about an axis, rad/s.
    pub(crate) rate_sd_radps: f64,
}

/// A difference across gravity, and its variance from noise on one axis.
type Difference = (Vector3<f64>, f64);

/// Time between the begin of a rotation and the end of this hold, s.
pub(crate) fn margin_s(hold: &Hold) -> f64 {
    (0.25 * hold.duration_s()).min(MARGIN_S)
}

/// Of each hold, with the turns within them. `sensor`: the accelerometer's parameters; `known`: the turns, where they are not to be estimated from these holds.
/// Nothing where the sensor's matrix is singular.
pub(crate) fn gravity_at_ends(
    accelerometer: &Recording,
    sensor: &SensorParameters,
    holds: &[&Hold],
    known: Option<TurnsInHolds>,
) -> (Vec<AtEnds>, TurnsInHolds) {
    let correction = Correction::of(sensor);
    let force = |hold: &Hold| correction.map_or_else(Vector3::zeros, |of| of.apply(&hold.mean));
    let difference = |hold: &Hold, (from_s, to_s): (f64, f64)| -> Option<Difference> {
        let (part, all) = (
            accelerometer.mean_between(from_s, to_s)?,
            accelerometer.mean_between(hold.start_s, hold.end_s)?,
        );
        let up = force(hold).try_normalize(0.0).unwrap_or_default();
        let by_reading = correction.map_or_else(Matrix3::zeros, |of| of.by_reading(sensor, &force(hold)));
        let difference = by_reading * (part.mean - all.mean);
        let of_sample = (by_reading * hold.sd).norm_squared() / 3.0;
        let of_mean = (1.0 / part.samples as f64 - 1.0 / all.samples as f64).max(0.0);
        Some((difference - up * up.dot(&difference), of_sample * of_mean))
    };
    let slack_s = ROUNDED_TIME_STEPS / accelerometer.rate_hz();
    let of_hold = |hold: &&Hold| {
        let about_s = 2.0 * margin_s(hold) + slack_s;
        [(hold.start_s, hold.start_s + about_s), (hold.end_s - about_s, hold.end_s)]
            .map(|part| difference(hold, part).unwrap_or_default())
    };
    let differences: Vec<[Difference; 2]> = holds.iter().map(of_hold).collect();
    let turns = known.unwrap_or_else(|| {
        let at_ends = beyond_noise(differences.iter().flatten().copied());
        // gravity changes by twice the difference in the duration of the hold
        let rates = holds.iter().map(|hold| 2.0 * at_ends.sqrt() / (force(hold).norm() * hold.duration_s()));
        let rate_sd_radps = if at_ends > 0.0 { median(rates.collect()) } else { 0.0 };
        TurnsInHolds { at_ends, rate_sd_radps }
    });
    let counts = |(difference, variance): Difference| match turns.at_ends > 0.0 {
        true => difference * (turns.at_ends / (turns.at_ends + variance)),
        false => Vector3::zeros(),
    };
    (differences.into_iter().map(|ends| ends.map(counts)).collect(), turns)
}

/// The variance of differences on one axis beyond their noise, or 0 where the noise explains them. Medians tell both: that of χ² with two degrees of freedom
/// is 2 ln 2, and has the relative standard deviation `1/(ln 2 √n)`.
fn beyond_noise(differences: impl Iterator<Item = Difference>) -> f64 {
    let (squares, variances): (Vec<f64>, Vec<f64>) =
        differences.map(|(difference, variance)| (difference.norm_squared(), variance)).unzip();
    if squares.is_empty() {
        return 0.0;
    }
    let by_chance = SIGNIFICANT / (LN_2 * (squares.len() as f64).sqrt());
    let (all, of_noise) = (median(squares) / (2.0 * LN_2), median(variances));
    if all > of_noise * (1.0 + by_chance) { all - of_noise } else { 0.0 }
}
