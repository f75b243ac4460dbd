//! Do the sensors share a clock? How much later the gyroscope shows movements than the accelerometer, and whether that grows.
//!
//! An offset that is the same in all rotations is a latency; one that grows by `s` per second is a clock that goes faster by this share, and a gain of the gyroscope that is larger by it, since turns are
//! integrated over its own times. A robust line through the offsets of the rotations gives both, and the scatter about it the standard deviations.
//!
//! # References
//! `mackinnon1985`

use crate::estimate::holds::median;
use crate::estimate::imu::clock::offset::{ComparedRotation, TimeOffset};
use crate::estimate::imu::clock::rate::ClockRate;
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::Recording;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Fewer rotations do not show an offset.
const FEWEST: usize = 6;

/// Offsets are looked for beside an arm this many times, each time from the line through those before.
const PASSES: usize = 2;

/// Offsets beside an arm count where they are found in this share of the rotations.
const FOUND_SHARE: f64 = 0.4;

/// Offsets this many standard deviations off the line do not count.
const OUTLYING_SD: f64 = 4.0;

/// There is no line where fewer than this share of the offsets agree.
const AGREEING_SHARE: f64 = 0.7;

/// Rounds in which offsets are left out.
const ROUNDS: usize = 8;

/// Probability of an offset, or of a skew, this large where there is none.
const BY_CHANCE: f64 = 1e-3;

/// The clocks of good quartzes differ by this share.
const COMMON_SKEW: f64 = 5e-5;

/// By how much the gyroscope's times are later than the accelerometer's: `offset_s + skew (t − at_s)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClockDifference {
    pub(crate) at_s: f64,
    pub(crate) offset_s: f64,
    pub(crate) offset_sd_s: f64,
    pub(crate) skew: f64,
    pub(crate) skew_sd: f64,
    pub(crate) degrees_of_freedom: usize,
}

impl ClockDifference {
    /// What the rotations say at a state; `None` where they are too few or disagree.
    pub(crate) fn of(model: &ImuModel<'_>, state: &State, accelerometer: &Recording) -> Option<Self> {
        let rotations: Vec<ComparedRotation<'_>> = model
            .rotations
            .par_iter()
            .filter_map(|rotation| ComparedRotation::of(rotation, state, accelerometer))
            .collect();
        let mut offsets: Vec<TimeOffset> =
            rotations.par_iter().filter_map(ComparedRotation::offset).collect();
        for _ in 0..PASSES {
            let (offset_s, skew) = median_line(&offsets)?;
            let near = |shown: &ComparedRotation<'_>| shown.offset_beside_arm(offset_s + skew * shown.at_s);
            let closer: Vec<TimeOffset> = rotations.par_iter().filter_map(near).collect();
            if (closer.len() as f64) < FOUND_SHARE * rotations.len() as f64 {
                break;
            }
            offsets = closer;
            if offsets.len() == rotations.len() {
                break;
            }
        }
        Self::through(&offsets)
    }

    /// The line through lags of which some may be outliers.
    fn through(offsets: &[TimeOffset]) -> Option<Self> {
        let (offset_s, skew) = median_line(offsets)?;
        let mut line =
            Self { at_s: 0.0, offset_s, offset_sd_s: 0.0, skew, skew_sd: 0.0, degrees_of_freedom: 0 };
        for _ in 0..ROUNDS {
            let off = |offset: &TimeOffset| (offset.offset_s - line.at(offset.at_s)) * offset.weight.sqrt();
            let scale = 1.4826 * median(offsets.iter().map(|offset| off(offset).abs()).collect());
            let kept: Vec<TimeOffset> =
                offsets.iter().filter(|offset| off(offset).abs() <= OUTLYING_SD * scale).copied().collect();
            if kept.len() < FEWEST || (kept.len() as f64) < AGREEING_SHARE * offsets.len() as f64 {
                return None;
            }
            let before = line.degrees_of_freedom;
            line = Self::least_squares(&kept, scale);
            if line.degrees_of_freedom == before {
                break;
            }
        }
        Some(line)
    }

    /// The line of least squares; the weighted lags scatter by `scale` at least.
    ///
    /// Rotations scatter by more than their weights tell: the variances are those of equal scatter or, where these are more, those by each lag's own distance from the line (HC3).
    fn least_squares(offsets: &[TimeOffset], scale: f64) -> Self {
        let sum = |of: &dyn Fn(&TimeOffset) -> f64| {
            offsets.iter().map(|offset| offset.weight * of(offset)).sum::<f64>()
        };
        let weight = sum(&|_| 1.0);
        let at_s = sum(&|offset| offset.at_s) / weight;
        let offset_s = sum(&|offset| offset.offset_s) / weight;
        let spread = sum(&|offset| (offset.at_s - at_s).powi(2));
        let skew = sum(&|offset| (offset.at_s - at_s) * offset.offset_s) / spread;
        let off = |offset: &TimeOffset| offset.offset_s - offset_s - skew * (offset.at_s - at_s);
        let degrees_of_freedom = offsets.len() - 2;
        let variance = (sum(&|offset| off(offset).powi(2)) / degrees_of_freedom as f64).max(scale * scale);
        let own = |offset: &TimeOffset| {
            let leverage = offset.weight * (1.0 / weight + (offset.at_s - at_s).powi(2) / spread);
            offset.weight * (off(offset) / (1.0 - leverage).max(0.1)).powi(2)
        };
        let of_offset = (variance / weight).max(sum(&own) / weight.powi(2));
        let of_skew = (variance / spread)
            .max(sum(&|offset| (offset.at_s - at_s).powi(2) * own(offset)) / spread.powi(2));
        // lags are of first order in the growth
        let (offset_sd_s, skew_sd) = (of_offset.sqrt(), of_skew.sqrt().hypot(skew * skew));
        Self { at_s, offset_s, offset_sd_s, skew, skew_sd, degrees_of_freedom }
    }

    /// The lag at a time of the gyroscope, s.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        self.offset_s + self.skew * (time_s - self.at_s)
    }

    /// Is a value this large no chance?
    pub(crate) fn is_certain(&self, value: f64, sd: f64) -> bool {
        let distribution = StudentsT::new(0.0, 1.0, self.degrees_of_freedom as f64).ok();
        distribution.is_some_and(|of| 2.0 * of.sf((value / sd).abs()) < BY_CHANCE)
    }

    /// The rates of the clocks, where they are certain to differ by more than those of good ones.
    pub(crate) fn rate(&self) -> Option<ClockRate> {
        let differ = self.skew.abs() > COMMON_SKEW && self.is_certain(self.skew, self.skew_sd);
        differ.then_some(ClockRate { faster: self.skew, sd: self.skew_sd })
    }
}

/// The lag at the time 0 and the growth that half of the lags are above, and half of their pairs; `None` of too few.
fn median_line(offsets: &[TimeOffset]) -> Option<(f64, f64)> {
    if offsets.len() < FEWEST {
        return None;
    }
    let pairs =
        offsets.iter().enumerate().flat_map(|(k, one)| offsets[..k].iter().map(move |other| (one, other)));
    let skew =
        median(pairs.map(|(one, other)| (one.offset_s - other.offset_s) / (one.at_s - other.at_s)).collect());
    Some((median(offsets.iter().map(|offset| offset.offset_s - skew * offset.at_s).collect()), skew))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::imu::checks::time_offset;
    use crate::simulate::{Purpose, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn recording(rate_hz: f64) -> Recording {
        let times_s = (0..(150.0 * rate_hz) as usize).map(|k| k as f64 / rate_hz).collect();
        Recording { times_s, readings: Vec::new(), axes: 3, unit: crate::sensor::ReadingUnit::Counts }
    }

    /// Simulates `count` recordings. Gives how many get a message, and the mean square of the skew's error in standard deviations.
    fn drawn(count: u64, rotations: usize, skew: f64, latency_s: f64) -> (usize, f64) {
        let (mut words, mut squares) = (0, 0.0);
        let [slow, fast] = [100.0, 200.0].map(recording);
        for number in 0..count {
            let mut rng = stream(5, Purpose::Sensor, number);
            let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
            let offset = |k: usize| {
                let (at_s, weight) = (5.0 * k as f64 + normal(), 22.0 * (1.0 + 0.5 * normal().tanh()));
                // one in twelve is an outlier
                let invalid = if k % 12 == 7 { 40.0 } else { 1.0 };
                let scatter = invalid * 0.022 / weight.sqrt() * normal();
                TimeOffset { at_s, offset_s: latency_s + skew * at_s + scatter, weight }
            };
            let offsets: Vec<TimeOffset> = (0..rotations).map(offset).collect();
            let Some(found) = ClockDifference::through(&offsets) else { continue };
            words += usize::from(time_offset::of_clock(&found, &slow, &fast).is_some());
            squares += ((found.skew - skew) / found.skew_sd).powi(2) / count as f64;
        }
        (words, squares)
    }

    #[test]
    fn the_line_through_lags_knows_its_uncertainty() {
        for rotations in [8, 12, 30] {
            let (words, squares) = drawn(1000, rotations, 0.0, 0.0);
            // (n − 2)/(n − 4) of Student's t
            let expected = (rotations as f64 - 2.0) / (rotations as f64 - 4.0);
            assert!((0.5 * expected..1.2 * expected).contains(&squares), "{rotations}: {squares}");
            assert!(words <= 5, "{rotations}: {words} of 1000");
        }
        let (words, squares) = drawn(500, 30, 2e-4, 0.0);
        assert!(words > 450 && squares < 1.4, "{words} {squares}");
        assert!(drawn(500, 30, 0.0, 0.05).0 > 490);
        // three milliseconds are not worth a word
        assert!(drawn(500, 30, 0.0, 0.003).0 < 5);
    }
}
