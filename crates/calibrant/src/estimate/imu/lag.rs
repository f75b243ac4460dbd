//! How much later than the accelerometer the gyroscope shows a rotation.
//!
//! Where gravity goes both sensors tell: the gyroscope carries it, `g(t)`, the accelerometer measures it, `f`. With the lag `L` of the gyroscope's times `f(t − L) = g(t)`, hence
//! `L = ∫ ġᵀ (f − g) dt / ∫ |ġ|² dt`, far below a sample: what a hand adds by accelerating has little to do with ġ.

use super::joint::{RotationData, State};
use super::rotation::exponential;
use crate::sensor::{Correction, Recording, interpolated};

/// Gravity is compared at times about so far apart, s.
const GRID_S: f64 = 0.1;
/// A lag that moved by more than this is refined once more, s.
const ROUGH_S: f64 = 0.01;
/// Refinements at most.
const ROUNDS: usize = 8;
/// Gravity must move by this in a rotation that tells of its lag, rad.
const MOVES_RAD: f64 = 0.5;

/// The lag of the gyroscope's times in a rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lag {
    /// Middle of the rotation by the gyroscope's times, s.
    pub(super) at_s: f64,
    /// How much later the gyroscope shows it, s.
    pub(super) lag_s: f64,
    /// `(∫ |ġ|² dt)^½`, by which it weighs: noise would have the square, but hands accelerate more the faster they turn.
    pub(super) weight: f64,
}

impl Lag {
    /// `None` for a rotation that is not used, hardly moves gravity, or in which the lag is not found.
    pub(super) fn of(rotation: &RotationData<'_>, state: &State, accelerometer: &Recording) -> Option<Self> {
        let samples = &rotation.samples;
        let imu = state.imu.at(samples.temperature_c());
        let (start_s, end_s) = (*samples.times_s.first()?, *samples.times_s.last()?);
        let step = (GRID_S * samples.times_s.len() as f64 / (end_s - start_s)).round().max(1.0) as usize;
        let last = samples.times_s.len() - 1;
        let times: Vec<f64> = (0..last).step_by(step).chain([last]).map(|k| samples.times_s[k]).collect();
        if !rotation.used || times.len() < 4 {
            return None;
        }
        // gravity by the gyroscope; what it misses at the end is spread over the rotation
        let by_rate = imu.gyroscope.matrix.try_inverse()?;
        let mut gravity = state.forces[rotation.from];
        let mut carried = vec![gravity];
        for turn in samples.cut_down(&imu.gyroscope.bias, step) {
            gravity = exponential(&-(by_rate * turn)) * gravity;
            carried.push(gravity);
        }
        let missed = (state.forces[rotation.from + 1] - gravity) / (carried.len() - 1) as f64;
        carried.iter_mut().enumerate().for_each(|(k, gravity)| *gravity += missed * k as f64);
        let path: f64 = carried.array_windows().map(|[one, next]| (next - one).norm()).sum();
        let force = Correction::of(&imu.accelerometer)?;
        let mut lag_s = 0.0;
        for _ in 0..ROUNDS {
            let (mut along, mut weight) = (0.0, 0.0);
            let known = accelerometer.between(start_s - lag_s, end_s - lag_s);
            let known = known.start.saturating_sub(1)..(known.end + 1).min(accelerometer.len());
            let (known_s, readings) = (&accelerometer.times_s[known.clone()], &accelerometer.readings[known]);
            for k in 1..times.len() - 1 {
                let change = carried[k + 1] - carried[k - 1];
                let reading = interpolated(known_s, |at| readings[at], times[k] - lag_s, 0)?;
                along += change.dot(&(force.apply(&reading) - carried[k]));
                weight += change.norm_squared() / (times[k + 1] - times[k - 1]);
            }
            let more = along / weight;
            lag_s += more;
            if more.abs() < ROUGH_S {
                let at_s = 0.5 * (start_s + end_s);
                let weight = weight.sqrt();
                return (path > MOVES_RAD * gravity.norm()).then_some(Self { at_s, lag_s, weight });
            }
        }
        None
    }
}
