//! Combinations of parameters that the data hardly determine.

use super::identify::ScaledInformation;
use nalgebra::{DMatrix, DVector};

/// A condition number at which the data no longer determine a combination: the noise in the directions of the holds then decides it.
const LARGEST_CONDITION: f64 = 1e5;

/// Parameters that make up the combinations whose information, scaled, is a vanishing part of the best, and not that of the prior.
pub(crate) fn hardly_determined(information: &DMatrix<f64>, prior: &DVector<f64>) -> Vec<usize> {
    let size = information.nrows();
    let ScaledInformation(eigen) = ScaledInformation::of(information);
    let floor = eigen.eigenvalues.max() / LARGEST_CONDITION;
    let is_prior = |e: usize| {
        let of_prior = |k: usize| eigen.eigenvectors[(k, e)].powi(2) * prior[k] / information[(k, k)];
        (0..size).map(of_prior).sum::<f64>() > 0.5 * eigen.eigenvalues[e]
    };
    (0..size)
        .filter(|&k| {
            let share: f64 = (0..size)
                .filter(|&e| eigen.eigenvalues[e] < floor && !is_prior(e))
                .map(|e| eigen.eigenvectors[(k, e)].powi(2))
                .sum();
            share > 0.1
        })
        .collect()
}
