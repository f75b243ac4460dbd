//! Are two recordings one, in disguise: rounded, in other units, thinned out, cut, with other times, or smoothed (`smoothed`)?
//!
//! Poses, motions and times may be the same in honest repetitions; noise is not. It is compared in the holds, where nothing else changes fast: `u` and `v` are the
//! differences of successive samples of both recordings, which have no unit, bias or drift in common, and
//!
//! ```text
//! r(l) = median over blocks of Σ_k u_k·v_{k+l} / √(Σ|u_k|² Σ|v_{k+l}|²)
//! ```
//!
//! Noise of its own makes `r(0)` about zero, the same noise nearly 1: what is left after rounding. A hum that both hear is as much in step at other shifts `l`, so that
//! `r(0)` must stand out among them. The median does not mind if a machine settles in the same way in the beginning of each hold.

use super::duplicate_smoothed::slow_noise_in_common;
use crate::estimate::holds::median;
use crate::motion::Hold;
use crate::sensor::{Recording, interpolated};
use nalgebra::Vector3;

/// Samples in a block.
const BLOCK: usize = 32;
/// With fewer blocks nothing is said: a median of 8 blocks of white noise, 96 numbers each, has a standard deviation of 0.055.
const LEAST_BLOCKS: usize = 8;
/// One sample in at most so many is left where a file is thinned out.
const MOST_THINNED: f64 = 10.0;
/// How far `r(0)` stands out where the noise is the same.
const STANDS_OUT: f64 = 0.35;
/// Shifts at which only a hum is in step; samples next to each other are, too, where the sensor filters.
const SHIFTS: std::ops::RangeInclusive<usize> = 4..=16;
/// Samples by which a smoothed recording may lag behind: moving averages over the last so many samples.
const LAGS: [f64; 5] = [0.0, 2.0, -2.0, 5.0, -5.0];

/// Correlation of the noise of two recordings of one sensor in the holds of the first, where it is so high that the data are the same; `None` where they are not.
///
/// Their samples are compared at the same times, then from the beginning and from the end of both, so that neither part of a recording nor one whose clock was set back escapes. The unit of the
/// readings does not matter. Noise of a smoothed recording is compared in means over longer stretches.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{find_holds, noise_in_common};
/// use calibrant_core::sensor::{ReadingUnit, SensorParameters};
/// use calibrant_core::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};
/// use nalgebra::Vector3;
///
/// let setup = HoldsSimulation { poses: 12, hold_s: 4.0, turn_s: 1.5, rate_hz: 100.0, gravity_mps2: 9.81, between_holds_sd_mps2: 0.0 };
/// let record = |seed| {
///     let unit = ReadingUnit::MetrePerSecondSquared;
///     simulate_holds(&SensorParameters::identity(), &Vector3::repeat(0.01), unit, &setup, &mut stream(seed, Purpose::Sensor, 0)).0
/// };
/// let (one, other) = (record(1), record(2));
/// let holds = find_holds(&one, 1.0)?;
/// let mut rounded = one.clone();
/// rounded.readings.iter_mut().for_each(|y| *y = y.map(|y| (y * 100.0).round() / 100.0));
/// assert!(noise_in_common(&one, &holds, &rounded).is_some_and(|r| r > 0.9));
/// assert_eq!(noise_in_common(&one, &holds, &other), None);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn noise_in_common(one: &Recording, holds: &[Hold], other: &Recording) -> Option<f64> {
    let ends = |recording: &Recording| Some((*recording.times_s.first()?, *recording.times_s.last()?));
    let ((start, end), (other_start, other_end)) = (ends(one)?, ends(other)?);
    let (rate, other_rate) = (one.rate_hz(), other.rate_hz());
    let mut delays = vec![0.0];
    // every n-th sample may begin with any of the first n
    let thinned = (rate / other_rate).max(other_rate / rate).round().clamp(1.0, MOST_THINNED);
    for sample in 0..thinned as usize {
        // those of the other recording where it is the one with fewer
        let skipped_s = (sample as f64 / rate.max(other_rate)).copysign(rate - other_rate);
        delays.extend([other_start - start - skipped_s, other_end - end + skipped_s]);
    }
    let fast = delays
        .into_iter()
        .filter_map(|delay_s| Differences::of(one, holds, other, delay_s).in_common())
        .max_by(f64::total_cmp);
    let slow = || {
        let ends = [other_start - start, other_end - end];
        // a filter may delay
        let delays = LAGS.into_iter().map(|lag| lag / rate.min(other_rate)).chain(ends);
        let found = delays.filter_map(|delay_s| slow_noise_in_common(one, holds, other, delay_s));
        found.max_by(f64::total_cmp)
    };
    fast.or_else(slow)
}

/// Differences of successive samples in holds, of two recordings at the same times.
#[derive(Default)]
struct Differences {
    one: Vec<Vector3<f64>>,
    other: Vec<Vector3<f64>>,
}

impl Differences {
    /// `delay_s`: what the clock of the other recording shows less that of the one.
    fn of(one: &Recording, holds: &[Hold], other: &Recording, delay_s: f64) -> Self {
        let mut found = Self::default();
        for hold in holds {
            let own = &one.times_s[one.between(hold.start_s, hold.end_s)];
            let others = &other.times_s[other.between(hold.start_s + delay_s, hold.end_s + delay_s)];
            let (Some(first), Some(last)) = (others.first(), others.last()) else { continue };
            // the times of the one with fewer samples, as far as there are some of both
            let times: Vec<f64> = if others.len() < own.len() {
                others.iter().map(|t| t - delay_s).collect()
            } else {
                own.iter().copied().filter(|t| (*first..=*last).contains(&(t + delay_s))).collect()
            };
            let differences = |recording: &Recording, delay_s: f64| -> Vec<Vector3<f64>> {
                let reading = |k: usize| recording.readings[k];
                let at = |t: &f64| interpolated(&recording.times_s, reading, t + delay_s, hold.first);
                let values: Vec<_> = times.iter().filter_map(at).collect();
                values.windows(2).map(|pair| pair[1] - pair[0]).collect()
            };
            found.one.extend(differences(one, 0.0));
            found.other.extend(differences(other, delay_s));
        }
        found
    }

    fn in_common(&self) -> Option<f64> {
        let in_step = self.correlation(0)?;
        let elsewhere =
            SHIFTS.filter_map(|shift| self.correlation(shift)).fold(0.0, |most: f64, r| most.max(r.abs()));
        (in_step > STANDS_OUT + elsewhere).then_some(in_step)
    }

    /// `r(l)`; `None` where too few blocks have noise in both.
    fn correlation(&self, shift: usize) -> Option<f64> {
        let blocks = self.one.chunks_exact(BLOCK).zip(self.other.get(shift..)?.chunks_exact(BLOCK));
        let found: Vec<f64> = blocks
            .filter_map(|(one, other)| {
                let power = |of: &[Vector3<f64>]| of.iter().map(Vector3::norm_squared).sum::<f64>();
                let product: f64 = one.iter().zip(other).map(|(u, v)| u.dot(v)).sum();
                let r = product / (power(one) * power(other)).sqrt();
                r.is_finite().then_some(r)
            })
            .collect();
        if found.len() < LEAST_BLOCKS {
            return None;
        }
        Some(median(found))
    }
}
