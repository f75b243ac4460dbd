//! Do the sensors share a clock? How much later the gyroscope shows movements than the accelerometer, and whether that grows.
//!
//! An offset that is the same in all rotations is a latency; one that grows by `s` per second is a clock that goes faster by this share, and a gain of the gyroscope that is larger by it, since turns are
//! integrated over its own times. Newton's method fits one robust line to all rotations.
//!
//! Where gravity goes both sensors show: the gyroscope propagates it, `g(t)`, the accelerometer measures it, `f`. With the offset `L` of the gyroscope's times `f(t − L) = g(t)`, so that
//! `Φ(L) = ∫ uᵀ (f(t − L) − g) dt` is zero with `u = ġ`, far below a sample: what a hand adds by accelerating has little to do with ġ.
//!
//! An arm `r` from the point about which a hand turns adds `A r` with `A = [ω̇]× + [ω]×²`, which is much in fast turns. With `u = ġ − A c`, `c` such that `∫ Aᵀ u dt = 0`, no arm moves
//! `Φ(L)`. The steps of the line use this `u`, from where gravity alone leads.
//!
//! # References
//! `mackinnon1985`

use crate::estimate::holds::median;
use crate::estimate::imu::clock_rate::{ClockRate, TimeOffset};
use crate::estimate::imu::least_squares::integration::exponential;
use crate::estimate::imu::model::{ImuModel, RotationData, State};
use crate::sensor::{Correction, Recording, SensorKind, interpolated};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Fewer rotations do not show an offset.
const FEWEST: usize = 6;

/// Newton steps of the line beside an arm.
const STEPS_BESIDE_ARM: usize = 3;

/// Offsets beside an arm count where they are found in this share of the rotations.
const FOUND_SHARE: f64 = 0.4;

/// Offsets this many standard deviations off the line do not count.
const OUTLYING_SD: f64 = 4.0;

/// There is no line where fewer than this share of the offsets agree.
const AGREEING_SHARE: f64 = 0.7;

/// Rounds in which offsets are left out, and Newton steps by gravity alone.
const ROUNDS: usize = 8;

/// A Newton step by gravity alone that is shorter is the last, s.
const ROUGH_S: f64 = 0.01;

/// Probability of an offset, or of a skew, this large where there is none.
const BY_CHANCE: f64 = 1e-3;

/// The clocks of good quartzes differ by this share.
const COMMON_SKEW: f64 = 5e-5;

/// A rotation is compared in this many intervals.
const INTERVALS: f64 = 32.0;

/// An interval is no shorter and no longer than these, s.
const GRID_S: [f64; 2] = [0.02, 0.1];

/// The slope of `Φ` is that between this much before and after, s.
const SLOPE_S: f64 = 0.01;

/// Longest Newton step beside an arm, s.
const LONGEST_S: f64 = 0.1;

/// Gravity must move by this in a rotation that shows its offset, rad.
const MOVES_RAD: f64 = 0.5;

/// Nothing is compared within this time of a knock, s: the other sensor may show it earlier.
const BESIDE_KNOCK_S: f64 = 0.03;

/// Below this `∫ |A e|² dt`, in s⁻³, nothing is known of an arm. Turns about one axis alone say nothing of the arm along it.
const NO_ARM: f64 = 0.04;

/// `Φ` falls by this share of `∫ |u|² dt` per s at least, or the root is another one.
const FALLS: f64 = 0.25;

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
        let compared = |rotation| ComparedRotation::of(rotation, state, accelerometer);
        let rotations: Vec<ComparedRotation<'_>> = model.rotations.par_iter().filter_map(compared).collect();
        let mut found: Vec<RotationOffset> =
            rotations.par_iter().filter_map(ComparedRotation::by_gravity).collect();
        for _ in 0..STEPS_BESIDE_ARM {
            let (offset_s, skew) = median_line(&found)?;
            let newton =
                |rotation: &ComparedRotation<'_>| rotation.beside_arm(offset_s + skew * rotation.at_s);
            let closer: Vec<RotationOffset> = rotations.par_iter().filter_map(newton).collect();
            if (closer.len() as f64) < FOUND_SHARE * rotations.len() as f64 {
                break;
            }
            found = closer;
        }
        Self::through(&found)
    }

    /// The line through lags of which some may be outliers.
    fn through(offsets: &[RotationOffset]) -> Option<Self> {
        let (offset_s, skew) = median_line(offsets)?;
        let mut line =
            Self { at_s: 0.0, offset_s, offset_sd_s: 0.0, skew, skew_sd: 0.0, degrees_of_freedom: 0 };
        for _ in 0..ROUNDS {
            let off =
                |offset: &RotationOffset| (offset.offset_s - line.at(offset.at_s)) * offset.weight.sqrt();
            let scale = 1.4826 * median(offsets.iter().map(|offset| off(offset).abs()).collect());
            let kept: Vec<RotationOffset> =
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
    fn least_squares(offsets: &[RotationOffset], scale: f64) -> Self {
        let sum = |of: &dyn Fn(&RotationOffset) -> f64| {
            offsets.iter().map(|offset| offset.weight * of(offset)).sum::<f64>()
        };
        let weight = sum(&|_| 1.0);
        let at_s = sum(&|offset| offset.at_s) / weight;
        let offset_s = sum(&|offset| offset.offset_s) / weight;
        let spread = sum(&|offset| (offset.at_s - at_s).powi(2));
        let skew = sum(&|offset| (offset.at_s - at_s) * offset.offset_s) / spread;
        let off = |offset: &RotationOffset| offset.offset_s - offset_s - skew * (offset.at_s - at_s);
        let degrees_of_freedom = offsets.len() - 2;
        let variance = (sum(&|offset| off(offset).powi(2)) / degrees_of_freedom as f64).max(scale * scale);
        let own = |offset: &RotationOffset| {
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

    /// The offset in the middle of the rotations.
    pub(crate) fn time_offset(&self) -> TimeOffset {
        let Self { offset_s, offset_sd_s: sd_s, degrees_of_freedom, .. } = *self;
        TimeOffset { offset_s, sd_s, degrees_of_freedom }
    }

    /// The rates of the clocks, where they are certain to differ by more than those of good ones.
    pub(crate) fn rate(&self) -> Option<ClockRate> {
        let differ = self.skew.abs() > COMMON_SKEW && self.is_certain(self.skew, self.skew_sd);
        differ.then_some(ClockRate { faster: self.skew, sd: self.skew_sd })
    }
}

/// The lag at the time 0 and the growth that half of the lags are above, and half of their pairs; `None` of too few.
fn median_line(offsets: &[RotationOffset]) -> Option<(f64, f64)> {
    if offsets.len() < FEWEST {
        return None;
    }
    let pairs =
        offsets.iter().enumerate().flat_map(|(k, one)| offsets[..k].iter().map(move |other| (one, other)));
    let skew =
        median(pairs.map(|(one, other)| (one.offset_s - other.offset_s) / (one.at_s - other.at_s)).collect());
    Some((median(offsets.iter().map(|offset| offset.offset_s - skew * offset.at_s).collect()), skew))
}

/// The lag of the gyroscope's times in a rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RotationOffset {
    /// Middle of the rotation by the gyroscope's times, s.
    at_s: f64,
    /// How much later the gyroscope shows it, s.
    offset_s: f64,
    /// `(∫ |ġ|² dt)^½`, by which it weighs: noise would have the square, but hands accelerate more the faster they turn.
    weight: f64,
}

/// A rotation as the gyroscope shows it, to be compared with the accelerometer.
struct ComparedRotation<'a> {
    /// Its middle, s.
    at_s: f64,
    accelerometer: &'a Recording,
    force: Correction,
    /// Each time, with gravity as it is carried there.
    propagated: Vec<(f64, Vector3<f64>)>,
    /// `2 ġ dt` at each.
    changes: Vec<Vector3<f64>>,
    /// `2 u dt` at each.
    along_no_arm: Vec<Vector3<f64>>,
    /// `2 ∫ |ġ|² dt` and `2 ∫ |u|² dt`.
    weights: [f64; 2],
}

impl<'a> ComparedRotation<'a> {
    /// `None` for a rotation that is not used or hardly moves gravity.
    fn of(rotation: &RotationData<'_>, state: &State, accelerometer: &'a Recording) -> Option<Self> {
        let samples = &rotation.samples;
        let imu = state.imu.at(samples.temperature_c());
        let (start_s, end_s) = (*samples.times_s.first()?, *samples.times_s.last()?);
        let grid_s = ((end_s - start_s) / INTERVALS).clamp(GRID_S[0], GRID_S[1]);
        let step = (grid_s * samples.times_s.len() as f64 / (end_s - start_s)).round().max(1.0) as usize;
        let last = samples.times_s.len() - 1;
        let times: Vec<f64> = (0..last).step_by(step).chain([last]).map(|k| samples.times_s[k]).collect();
        if !rotation.used || times.len() < 4 {
            return None;
        }
        // gravity by the gyroscope; what it misses at the end is spread over the rotation
        let by_rate = imu[SensorKind::Gyroscope].matrix.try_inverse()?;
        let turns: Vec<Vector3<f64>> = samples
            .cut_down(&imu[SensorKind::Gyroscope].bias, step)
            .into_iter()
            .map(|turn| by_rate * turn)
            .collect();
        let mut gravity = state.forces[rotation.from];
        let mut propagated = vec![gravity];
        for turn in &turns {
            gravity = exponential(&-turn) * gravity;
            propagated.push(gravity);
        }
        let missed = (state.forces[rotation.from + 1] - gravity) / (propagated.len() - 1) as f64;
        propagated.iter_mut().enumerate().for_each(|(k, gravity)| *gravity += missed * k as f64);
        let path: f64 = propagated.array_windows().map(|[one, next]| (next - one).norm()).sum();
        if path < MOVES_RAD * gravity.norm() {
            return None;
        }
        let between = 1..times.len() - 1;
        // a knock is an acceleration of its own, and says little of the offset
        let is_knocked = |k: usize| {
            let near = times[k - 1] - BESIDE_KNOCK_S..times[k + 1] + BESIDE_KNOCK_S;
            rotation.knocks.times_s.iter().any(|time_s| near.contains(time_s))
        };
        let change =
            |k: usize| if is_knocked(k) { Vector3::zeros() } else { propagated[k + 1] - propagated[k - 1] };
        let changes: Vec<Vector3<f64>> = between.clone().map(change).collect();
        let spans: Vec<f64> = between.clone().map(|k| times[k + 1] - times[k - 1]).collect();
        let arms: Vec<Matrix3<f64>> = between
            .clone()
            .map(|k| {
                if is_knocked(k) {
                    return Matrix3::zeros();
                }
                let [before, after] = [k - 1, k].map(|k| turns[k] / (times[k + 1] - times[k]));
                let rate = (0.5 * (before + after)).cross_matrix();
                ((after - before) * (2.0 / spans[k - 1])).cross_matrix() + rate * rate
            })
            .collect();
        let (mut of_arm, mut with_change) = (Matrix3::identity() * NO_ARM, Vector3::zeros());
        for ((arm, span), change) in arms.iter().zip(&spans).zip(&changes) {
            of_arm += arm.tr_mul(arm) * *span;
            with_change += arm.tr_mul(change);
        }
        let looks_alike = of_arm.cholesky()?.solve(&with_change);
        let along_no_arm: Vec<Vector3<f64>> = arms
            .iter()
            .zip(&spans)
            .zip(&changes)
            .map(|((arm, span), change)| change - arm * looks_alike * *span)
            .collect();
        let weights = [&changes, &along_no_arm].map(|along| {
            along
                .iter()
                .zip(&changes)
                .zip(&spans)
                .map(|((along, change), span)| along.dot(change) / span)
                .sum()
        });
        Some(Self {
            at_s: 0.5 * (start_s + end_s),
            accelerometer,
            force: Correction::of(&imu[SensorKind::Accelerometer])?,
            propagated: between.map(|k| (times[k], propagated[k])).collect(),
            changes,
            along_no_arm,
            weights,
        })
    }

    /// `2 ∫ alongᵀ (f(t − L) − g) dt`.
    fn missed(&self, along: &[Vector3<f64>], offset_s: f64) -> Option<f64> {
        let [(first_s, _), .., (last_s, _)] = self.propagated.as_slice() else { return None };
        let known = self.accelerometer.between(first_s - offset_s, last_s - offset_s);
        let known = known.start.saturating_sub(1)..(known.end + 1).min(self.accelerometer.len());
        let (times_s, readings) =
            (&self.accelerometer.times_s[known.clone()], &self.accelerometer.readings[known]);
        let at = |((time_s, gravity), along): (&(f64, Vector3<f64>), &Vector3<f64>)| {
            let reading = interpolated(times_s, |at| readings[at], time_s - offset_s, 0)?;
            Some(along.dot(&(self.force.apply(&reading) - gravity)))
        };
        self.propagated.iter().zip(along).map(at).sum()
    }

    /// The offset by gravity alone; `None` where it is not found.
    fn by_gravity(&self) -> Option<RotationOffset> {
        let mut offset_s = 0.0;
        for _ in 0..ROUNDS {
            let more = self.missed(&self.changes, offset_s)? / self.weights[0];
            offset_s += more;
            if more.abs() < ROUGH_S {
                return Some(RotationOffset { at_s: self.at_s, offset_s, weight: self.weights[0].sqrt() });
            }
        }
        None
    }

    /// A Newton step whatever the arm is; `None` where it leads to no root nearby.
    fn beside_arm(&self, near_s: f64) -> Option<RotationOffset> {
        let missed = |offset_s: f64| self.missed(&self.along_no_arm, offset_s);
        let slope = (missed(near_s + SLOPE_S)? - missed(near_s - SLOPE_S)?) / (2.0 * SLOPE_S);
        let more = -missed(near_s)? / slope;
        let leads = slope < -FALLS * self.weights[1] && more.abs() < LONGEST_S;
        let weight = -slope / self.weights[1].sqrt();
        leads.then_some(RotationOffset { at_s: self.at_s, offset_s: near_s + more, weight })
    }
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
                RotationOffset { at_s, offset_s: latency_s + skew * at_s + scatter, weight }
            };
            let offsets: Vec<RotationOffset> = (0..rotations).map(offset).collect();
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
