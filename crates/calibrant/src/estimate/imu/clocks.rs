//! Do the sensors share a clock? How much later the gyroscope shows movements than the accelerometer, and whether that grows.
//!
//! A lag that is the same in all rotations is a latency; one that grows by `s` per second is a clock that goes faster by this share, and a gain of the gyroscope that is larger by it, since turns are
//! integrated over its own times. A robust line through the lags of the rotations gives both, and the scatter about it the standard deviations.
//!
//! # References
//! `mackinnon1985`

use super::joint::{Joint, State};
use super::lag::{Lag, Shown};
use crate::estimate::holds::median;
use crate::sensor::Recording;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Fewer rotations do not tell.
const FEWEST: usize = 6;
/// Lags are looked for beside an arm so many times, from the line through those before,
const PASSES: usize = 2;
/// and count where they are found in this share of the rotations.
const FOUND: f64 = 0.4;
/// Lags this many standard deviations off the line do not count,
const OUTLYING: f64 = 4.0;
/// if most do.
const AGREEING: f64 = 0.7;
/// Rounds in which lags are left out.
const ROUNDS: usize = 8;
/// Probability of a lag, or of a growth, this large where there is none.
const BY_CHANCE: f64 = 1e-3;
/// A lag of fewer sample intervals, or of less than so many s, needs no word.
const INTERVALS: f64 = 1.5;
const SHORT_S: f64 = 0.005;
/// Nor does a rate that differs by less than this share, as those of good quartzes do.
const COMMON: f64 = 5e-5;

/// The gyroscope's clock beside the accelerometer's, where they go at different rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockRate {
    /// By this share of the time the gyroscope's goes faster, and by this share its gains are too large if the accelerometer's is right.
    pub faster: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// By how much the gyroscope's times are later than the accelerometer's: `lag_s + growth (t − at_s)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClockDifference {
    at_s: f64,
    lag_s: f64,
    lag_sd_s: f64,
    growth: f64,
    growth_sd: f64,
    degrees_of_freedom: usize,
}

impl ClockDifference {
    /// What the rotations say at a state; `None` where they are too few or disagree.
    pub(super) fn of(joint: &Joint<'_>, state: &State, accelerometer: &Recording) -> Option<Self> {
        let rotations: Vec<Shown<'_>> = joint
            .rotations
            .par_iter()
            .filter_map(|rotation| Shown::of(rotation, state, accelerometer))
            .collect();
        let mut lags: Vec<Lag> = rotations.par_iter().filter_map(Shown::lag).collect();
        for _ in 0..PASSES {
            let (lag_s, growth) = median_line(&lags)?;
            let near = |shown: &Shown<'_>| shown.lag_beside_arm(lag_s + growth * shown.at_s);
            let closer: Vec<Lag> = rotations.par_iter().filter_map(near).collect();
            if (closer.len() as f64) < FOUND * rotations.len() as f64 {
                break;
            }
            lags = closer;
            if lags.len() == rotations.len() {
                break;
            }
        }
        Self::through(&lags)
    }

    /// The line through lags of which some may be wild.
    fn through(lags: &[Lag]) -> Option<Self> {
        let (lag_s, growth) = median_line(lags)?;
        let mut line =
            Self { at_s: 0.0, lag_s, lag_sd_s: 0.0, growth, growth_sd: 0.0, degrees_of_freedom: 0 };
        for _ in 0..ROUNDS {
            let off = |lag: &Lag| (lag.lag_s - line.at(lag.at_s)) * lag.weight.sqrt();
            let scale = 1.4826 * median(lags.iter().map(|lag| off(lag).abs()).collect());
            let kept: Vec<Lag> =
                lags.iter().filter(|lag| off(lag).abs() <= OUTLYING * scale).copied().collect();
            if kept.len() < FEWEST || (kept.len() as f64) < AGREEING * lags.len() as f64 {
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
    fn least_squares(lags: &[Lag], scale: f64) -> Self {
        let sum = |of: &dyn Fn(&Lag) -> f64| lags.iter().map(|lag| lag.weight * of(lag)).sum::<f64>();
        let weight = sum(&|_| 1.0);
        let at_s = sum(&|lag| lag.at_s) / weight;
        let lag_s = sum(&|lag| lag.lag_s) / weight;
        let spread = sum(&|lag| (lag.at_s - at_s).powi(2));
        let growth = sum(&|lag| (lag.at_s - at_s) * lag.lag_s) / spread;
        let off = |lag: &Lag| lag.lag_s - lag_s - growth * (lag.at_s - at_s);
        let degrees_of_freedom = lags.len() - 2;
        let variance = (sum(&|lag| off(lag).powi(2)) / degrees_of_freedom as f64).max(scale * scale);
        let own = |lag: &Lag| {
            let leverage = lag.weight * (1.0 / weight + (lag.at_s - at_s).powi(2) / spread);
            lag.weight * (off(lag) / (1.0 - leverage).max(0.1)).powi(2)
        };
        let of_lag = (variance / weight).max(sum(&own) / weight.powi(2));
        let of_growth =
            (variance / spread).max(sum(&|lag| (lag.at_s - at_s).powi(2) * own(lag)) / spread.powi(2));
        // lags are of first order in the growth
        let (lag_sd_s, growth_sd) = (of_lag.sqrt(), of_growth.sqrt().hypot(growth * growth));
        Self { at_s, lag_s, lag_sd_s, growth, growth_sd, degrees_of_freedom }
    }

    /// The lag at a time of the gyroscope, s.
    fn at(&self, time_s: f64) -> f64 {
        self.lag_s + self.growth * (time_s - self.at_s)
    }

    fn is_certain(&self, value: f64, sd: f64) -> bool {
        let distribution = StudentsT::new(0.0, 1.0, self.degrees_of_freedom as f64).ok();
        distribution.is_some_and(|of| 2.0 * of.sf((value / sd).abs()) < BY_CHANCE)
    }

    /// The rates of the clocks, where they are certain to differ by more than those of good ones.
    pub(super) fn rate(&self) -> Option<ClockRate> {
        let differ = self.growth.abs() > COMMON && self.is_certain(self.growth, self.growth_sd);
        differ.then_some(ClockRate { faster: self.growth, sd: self.growth_sd })
    }

    /// What to say of it, where it is certain and matters.
    pub(super) fn words(&self, accelerometer: &Recording, gyroscope: &Recording) -> Option<String> {
        let (first, last) = (*gyroscope.times_s.first()?, *gyroscope.times_s.last()?);
        if self.rate().is_some() {
            return Some(format!(
                "the clocks of the two sensors go at different rates: the gyroscope shows movements {} than the accelerometer at the beginning and {} at the end, {:+.4} ± {:.4} % of the time; its \
                 gains are too {} by this share if the accelerometer's clock is right: {}",
                late(self.at(first), 1),
                late(self.at(last), 1),
                100.0 * self.growth,
                100.0 * self.growth_sd,
                if self.growth > 0.0 { "large" } else { "small" },
                repair(self.at(first), self.growth, 3)
            ));
        }
        let step = accelerometer.rate_hz().min(gyroscope.rate_hz()).recip();
        let matters = self.lag_s.abs() > SHORT_S.max(INTERVALS * step);
        (matters && self.is_certain(self.lag_s, self.lag_sd_s)).then(|| {
            format!(
                "the gyroscope shows movements {} than the accelerometer (± {:.1} ms): a latency, or clocks that were set differently; holds and rotations are cut short by it: {}",
                late(self.lag_s, 1),
                1e3 * self.lag_sd_s,
                repair(self.lag_s, 0.0, 4)
            )
        })
    }
}

/// The lag at the time 0 and the growth that half of the lags are above, and half of their pairs; `None` of too few.
fn median_line(lags: &[Lag]) -> Option<(f64, f64)> {
    if lags.len() < FEWEST {
        return None;
    }
    let pairs = lags.iter().enumerate().flat_map(|(k, one)| lags[..k].iter().map(move |other| (one, other)));
    let growth =
        median(pairs.map(|(one, other)| (one.lag_s - other.lag_s) / (one.at_s - other.at_s)).collect());
    Some((median(lags.iter().map(|lag| lag.lag_s - growth * lag.at_s).collect()), growth))
}

/// `12.3 ms later`.
pub(super) fn late(lag_s: f64, digits: usize) -> String {
    format!("{:.digits$} ms {}", 1e3 * lag_s.abs(), if lag_s > 0.0 { "later" } else { "earlier" })
}

/// What puts the gyroscope's times right that are late by this at the first sample and later by `growth` with each second.
pub(super) fn repair(first_s: f64, growth: f64, digits: usize) -> String {
    let shift = match first_s > 0.0 {
        true => format!("subtract {first_s:.digits$} s from"),
        false => format!("add {:.digits$} s to", -first_s),
    };
    if growth == 0.0 {
        return format!("{shift} the gyroscope's times");
    }
    let factor =
        format!("multiply the time since the gyroscope's first sample by {:.*}", digits + 3, 1.0 - growth);
    let is_little = first_s.abs() < 0.5 * 10.0_f64.powi(-(digits as i32));
    if is_little { factor } else { format!("{factor}, and {shift} its times") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Purpose, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn recording(rate_hz: f64) -> Recording {
        let times_s = (0..(150.0 * rate_hz) as usize).map(|k| k as f64 / rate_hz).collect();
        Recording { times_s, readings: Vec::new(), axes: 3, unit: crate::sensor::ReadingUnit::Counts }
    }

    /// Of so many recordings, in how many a word is said, and the mean square of the growth's error in standard deviations.
    fn drawn(count: u64, rotations: usize, growth: f64, latency_s: f64) -> (usize, f64) {
        let (mut words, mut squares) = (0, 0.0);
        let [slow, fast] = [100.0, 200.0].map(recording);
        for number in 0..count {
            let mut rng = stream(5, Purpose::Sensor, number);
            let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
            let lag = |k: usize| {
                let (at_s, weight) = (5.0 * k as f64 + normal(), 22.0 * (1.0 + 0.5 * normal().tanh()));
                // one in twelve is wild
                let wild = if k % 12 == 7 { 40.0 } else { 1.0 };
                let scatter = wild * 0.022 / weight.sqrt() * normal();
                Lag { at_s, lag_s: latency_s + growth * at_s + scatter, weight }
            };
            let lags: Vec<Lag> = (0..rotations).map(lag).collect();
            let Some(found) = ClockDifference::through(&lags) else { continue };
            words += usize::from(found.words(&slow, &fast).is_some());
            squares += ((found.growth - growth) / found.growth_sd).powi(2) / count as f64;
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
