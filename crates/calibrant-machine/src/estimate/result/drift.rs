//! Does a sensor drift through the recording? Its residuals then follow the time (the bias), or its readings times the time (the gains).
//!
//! Both are regressed on the residuals of each axis, with what the fit has taken up already (a constant and the readings) projected out. The standard deviation
//! is from the scatter of blocks of time (sandwich, `newey1987`), so residuals may be correlated within them.

use super::sample_residual::SampleResidual;
use calibrant_core::diagnostic::Changed;
use nalgebra::{Matrix4, Vector3, Vector4};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Number of blocks: few enough to be longer than a motion's swing, and enough to tell a variance.
const BLOCKS: usize = 20;

/// A change of a sensor in proportion to time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorDrift {
    /// What changes: bias or gains.
    pub of: Changed,
    /// By how much from begin to end, per axis: in the unit of the readings, or as a share of the gain.
    pub amount: Vector3<f64>,
    /// Its standard deviation.
    pub sd: Vector3<f64>,
    /// p-value of none.
    pub p_value: f64,
}

/// The drift that explains the residuals best; `None` with too few of them. `without_bias`: the readings of the samples less the bias.
pub(super) fn find(residuals: &[SampleResidual], without_bias: &[Vector3<f64>]) -> Option<SensorDrift> {
    let (first, last) = (residuals.first()?.time_s, residuals.last()?.time_s);
    let part = |k: usize| (residuals[k].time_s - first) / (last - first) - 0.5;
    let of_bias = regression(residuals, without_bias, Changed::Bias, &|k, _| part(k));
    let of_gains =
        regression(residuals, without_bias, Changed::Gain, &|k, axis| part(k) * without_bias[k][axis]);
    [of_bias, of_gains].into_iter().flatten().min_by(|one, other| one.p_value.total_cmp(&other.p_value))
}

fn regression(
    residuals: &[SampleResidual],
    readings: &[Vector3<f64>],
    of: Changed,
    regressor: &dyn Fn(usize, usize) -> f64,
) -> Option<SensorDrift> {
    let per_block = residuals.len() / BLOCKS;
    if per_block < 10 {
        return None;
    }
    let size = readings.iter().map(Vector3::amax).fold(f64::MIN_POSITIVE, f64::max);
    let (mut amount, mut sd, mut squares, mut degrees) =
        (Vector3::zeros(), Vector3::zeros(), 0.0, f64::INFINITY);
    for axis in 0..3 {
        let weight = |k: usize| residuals[k].weights()[axis] / residuals[k].sd[axis].powi(2);
        let taken_up = |k: usize| (readings[k] / size).push(1.0);
        let (mut normal, mut right) = (Matrix4::identity() * f64::MIN_POSITIVE, Vector4::zeros());
        for k in 0..residuals.len() {
            let row = taken_up(k);
            normal += row * row.transpose() * weight(k);
            right += row * (weight(k) * regressor(k, axis));
        }
        // where readings do not change, they are the constant
        normal += Matrix4::from_diagonal(&normal.diagonal()) * 1e-9;
        let common = normal.cholesky()?.solve(&right);
        let own = |k: usize| regressor(k, axis) - taken_up(k).dot(&common);
        let blocks: Vec<(f64, f64)> = (0..BLOCKS)
            .map(|block| {
                let samples = block * per_block..(block + 1) * per_block;
                samples.fold((0.0, 0.0), |(score, information), k| {
                    let weighted = weight(k) * own(k);
                    (score + weighted * residuals[k].value[axis], information + weighted * own(k))
                })
            })
            .collect();
        let score: f64 = blocks.iter().map(|block| block.0).sum();
        let information: f64 = blocks.iter().map(|block| block.1).sum();
        let slope = score / information;
        let scatter: f64 = blocks.iter().map(|block| (block.0 - slope * block.1).powi(2)).sum();
        let number = BLOCKS as f64;
        amount[axis] = slope;
        sd[axis] = (scatter * number / (number - 1.0)).sqrt() / information;
        squares += (slope / sd[axis]).powi(2);
        // the blocks that tell it
        let concentration: f64 = blocks.iter().map(|block| (block.1 / information).powi(2)).sum();
        degrees = f64::min(degrees, 1.0 / concentration - 1.0);
    }
    let distribution = FisherSnedecor::new(3.0, degrees.max(1.0)).ok()?;
    let is_finite = squares.is_finite() && amount.iter().chain(&sd).all(|value| value.is_finite());
    is_finite.then(|| SensorDrift { of, amount, sd, p_value: distribution.sf(squares / 3.0) })
}
