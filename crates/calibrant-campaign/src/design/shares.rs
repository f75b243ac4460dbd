//! The best mixture of campaigns: Newton's method on the simplex of their shares.

use crate::Campaign;
use nalgebra::{DMatrix, DVector};

/// Largest number of steps.
const STEPS: usize = 60;
/// A step that is expected to lower the criterion by less than this share ends the search.
const ENOUGH: f64 = 1e-13;
/// Shares below this are none.
const NONE: f64 = 1e-10;

/// The information of each channel, of the mixture with these shares.
pub(super) fn mixed(
    known: &[DMatrix<f64>],
    atoms: &[Vec<DMatrix<f64>>],
    share: &DVector<f64>,
) -> Vec<DMatrix<f64>> {
    let mut sum = known.to_vec();
    for (atom, share) in atoms.iter().zip(share.iter()).filter(|(_, share)| **share > 0.0) {
        for (sum, atom) in sum.iter_mut().zip(atom) {
            *sum += atom * *share;
        }
    }
    sum
}

/// The shares at the least criterion. `atoms`: what each campaign tells of each channel.
pub(super) fn best(
    campaign: &Campaign,
    known: &[DMatrix<f64>],
    atoms: &[Vec<DMatrix<f64>>],
    mut share: DVector<f64>,
) -> Option<DVector<f64>> {
    let value = |share: &DVector<f64>| campaign.value_of(&mixed(known, atoms, share));
    let mut now = value(&share)?;
    for _ in 0..STEPS {
        let free: Vec<usize> = (0..share.len()).filter(|&k| share[k] > 0.0).collect();
        let Some((gradient, hessian)) = derivatives(campaign, &mixed(known, atoms, &share), atoms, &free)
        else {
            break;
        };
        let Some(step) = step(&gradient, hessian) else { break };
        let decrease = -gradient.dot(&step);
        if decrease <= ENOUGH * now.abs() {
            break;
        }
        let falling = free.iter().zip(step.iter()).filter(|(_, step)| **step < 0.0);
        let mut size = 0.95 * falling.map(|(&k, step)| -share[k] / step).fold(f64::INFINITY, f64::min);
        size = size.min(1.0);
        let moved = loop {
            let mut trial = share.clone();
            for (&k, step) in free.iter().zip(step.iter()) {
                trial[k] = (trial[k] + size * step).max(0.0);
            }
            trial /= trial.sum();
            match value(&trial).filter(|then| *then <= now - 1e-4 * size * decrease) {
                Some(then) => break Some((trial, then)),
                None if size > 1e-9 => size *= 0.5,
                None => break None,
            }
        };
        let Some((trial, then)) = moved else { break };
        now = then;
        share = trial.map(|share| if share > NONE { share } else { 0.0 });
        share /= share.sum();
    }
    Some(share)
}

/// First and second derivatives by the free shares: `−tr(A G)`, and `tr(A M⁻¹ B G)` once or twice.
fn derivatives(
    campaign: &Campaign,
    information: &[DMatrix<f64>],
    atoms: &[Vec<DMatrix<f64>>],
    free: &[usize],
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let gradients = campaign.gradient_of(information)?;
    let count = free.len();
    let (mut first, mut second) = (DVector::zeros(count), DMatrix::zeros(count, count));
    for (channel, of) in gradients.iter().enumerate() {
        let size = of.inverse.nrows();
        // each atom as a column: A M⁻¹, and (A G)ᵀ, so that a product of columns is the trace
        let (mut left, mut right) = (DMatrix::zeros(size * size, count), DMatrix::zeros(size * size, count));
        for (column, &k) in free.iter().enumerate() {
            let atom = &atoms[k][channel];
            let weighted = atom * &of.gradient;
            first[column] -= weighted.trace();
            left.column_mut(column).copy_from_slice((atom * &of.inverse).as_slice());
            right.column_mut(column).copy_from_slice(weighted.transpose().as_slice());
        }
        second.gemm_tr(campaign.criterion.curvature(), &left, &right, 1.0);
    }
    let second = 0.5 * (&second + second.transpose());
    Some((first, second))
}

/// Newton's step within the plane of equal sum.
fn step(gradient: &DVector<f64>, mut hessian: DMatrix<f64>) -> Option<DVector<f64>> {
    let ridge = 1e-11 * hessian.trace();
    for k in 0..gradient.len() {
        hessian[(k, k)] += ridge;
    }
    let factor = hessian.cholesky()?;
    let (of_gradient, of_one) = (factor.solve(gradient), factor.solve(&DVector::repeat(gradient.len(), 1.0)));
    let multiplier = of_gradient.sum() / of_one.sum();
    Some(of_one * multiplier - of_gradient)
}
