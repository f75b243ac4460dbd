//! How much later than the accelerometer the gyroscope shows a rotation.
//!
//! Where gravity goes both sensors tell: the gyroscope carries it, `g(t)`, the accelerometer measures it, `f`. With the offset `L` of the gyroscope's times `f(t − L) = g(t)`, hence
//! `L = ∫ ġᵀ (f − g) dt / ∫ |ġ|² dt`, far below a sample: what a hand adds by accelerating has little to do with ġ.
//!
//! An arm `r` from the point about which a hand turns adds `A r` with `A = [ω̇]× + [ω]×²`, which is much in fast turns. With `u = ġ − A c`, `c` such that `∫ Aᵀ u dt = 0`, no arm moves
//! `Φ(L) = ∫ uᵀ (f(t − L) − g) dt`; its root is found by secants from a lag near it.

use crate::estimate::imu::least_squares::integration::exponential;
use crate::estimate::imu::model::{RotationData, State};
use crate::sensor::{Correction, Recording, interpolated};
use nalgebra::{Matrix3, Vector3};

/// A rotation is compared in this many steps.
const STEPS: f64 = 32.0;

/// A step is no shorter and no longer than these, s.
const GRID_S: [f64; 2] = [0.02, 0.1];

/// An offset that moved by more than this is refined once more, s.
const ROUGH_S: f64 = 0.01;

/// The same where it is found beside an arm, s.
const FINE_S: f64 = 1e-3;

/// Longest step of the search beside an arm, s.
const LONGEST_S: f64 = 0.1;

/// Refinements at most.
const ROUNDS: usize = 8;

/// Gravity must move by this in a rotation that shows its offset, rad.
const MOVES_RAD: f64 = 0.5;

/// Below this `∫ |A e|² dt`, in s⁻³, nothing is known of an arm. Turns about one axis alone say nothing of the arm along it.
const NO_ARM: f64 = 0.04;

/// `Φ` falls by this share of `∫ |u|² dt` per s at least, or the root is another one.
const FALLS: f64 = 0.25;

/// The lag of the gyroscope's times in a rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeOffset {
    /// Middle of the rotation by the gyroscope's times, s.
    pub(crate) at_s: f64,
    /// How much later the gyroscope shows it, s.
    pub(crate) offset_s: f64,
    /// `(∫ |ġ|² dt)^½`, by which it weighs: noise would have the square, but hands accelerate more the faster they turn.
    pub(crate) weight: f64,
}

/// A rotation as the gyroscope shows it, to be compared with the accelerometer.
pub(crate) struct ComparedRotation<'a> {
    /// Its middle, s.
    pub(crate) at_s: f64,
    accelerometer: &'a Recording,
    force: Correction,
    /// Each time, with gravity as it is carried there.
    propagated: Vec<(f64, Vector3<f64>)>,
    /// `2 ġ dt` at each.
    changes: Vec<Vector3<f64>>,
    /// `2 u dt` at each.
    beside_arm: Vec<Vector3<f64>>,
    /// `2 ∫ |ġ|² dt` and `2 ∫ |u|² dt`.
    weights: [f64; 2],
}

impl<'a> ComparedRotation<'a> {
    /// `None` for a rotation that is not used or hardly moves gravity.
    pub(crate) fn of(
        rotation: &RotationData<'_>,
        state: &State,
        accelerometer: &'a Recording,
    ) -> Option<Self> {
        let samples = &rotation.samples;
        let imu = state.imu.at(samples.temperature_c());
        let (start_s, end_s) = (*samples.times_s.first()?, *samples.times_s.last()?);
        let grid_s = ((end_s - start_s) / STEPS).clamp(GRID_S[0], GRID_S[1]);
        let step = (grid_s * samples.times_s.len() as f64 / (end_s - start_s)).round().max(1.0) as usize;
        let last = samples.times_s.len() - 1;
        let times: Vec<f64> = (0..last).step_by(step).chain([last]).map(|k| samples.times_s[k]).collect();
        if !rotation.used || times.len() < 4 {
            return None;
        }
        // gravity by the gyroscope; what it misses at the end is spread over the rotation
        let by_rate = imu.gyroscope.matrix.try_inverse()?;
        let turns: Vec<Vector3<f64>> =
            samples.cut_down(&imu.gyroscope.bias, step).into_iter().map(|turn| by_rate * turn).collect();
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
        let changes: Vec<Vector3<f64>> =
            between.clone().map(|k| propagated[k + 1] - propagated[k - 1]).collect();
        let spans: Vec<f64> = between.clone().map(|k| times[k + 1] - times[k - 1]).collect();
        let arms: Vec<Matrix3<f64>> = between
            .clone()
            .map(|k| {
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
        let beside_arm: Vec<Vector3<f64>> = arms
            .iter()
            .zip(&spans)
            .zip(&changes)
            .map(|((arm, span), change)| change - arm * looks_alike * *span)
            .collect();
        let weights = [&changes, &beside_arm].map(|along| {
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
            force: Correction::of(&imu.accelerometer)?,
            propagated: between.map(|k| (times[k], propagated[k])).collect(),
            changes,
            beside_arm,
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

    /// The lag by gravity alone; `None` where it is not found.
    pub(crate) fn offset(&self) -> Option<TimeOffset> {
        let mut offset_s = 0.0;
        for _ in 0..ROUNDS {
            let more = self.missed(&self.changes, offset_s)? / self.weights[0];
            offset_s += more;
            if more.abs() < ROUGH_S {
                return Some(TimeOffset { at_s: self.at_s, offset_s, weight: self.weights[0].sqrt() });
            }
        }
        None
    }

    /// The lag whatever the arm is, near one that is known roughly; `None` where it is not found.
    pub(crate) fn offset_beside_arm(&self, near_s: f64) -> Option<TimeOffset> {
        let (mut before_s, mut offset_s) = (near_s, near_s + ROUGH_S);
        let mut before = self.missed(&self.beside_arm, before_s)?;
        for _ in 0..ROUNDS {
            let here = self.missed(&self.beside_arm, offset_s)?;
            let slope = (here - before) / (offset_s - before_s);
            if slope > -FALLS * self.weights[1] {
                return None;
            }
            (before_s, before) = (offset_s, here);
            let more = (-here / slope).clamp(-LONGEST_S, LONGEST_S);
            offset_s += more;
            if more.abs() < FINE_S {
                return Some(TimeOffset {
                    at_s: self.at_s,
                    offset_s,
                    weight: -slope / self.weights[1].sqrt(),
                });
            }
        }
        None
    }
}
