//! The bound that no set of n allowed poses can beat.
//!
//! For `M′ = M₀ + Σ m(u_k)` with n allowed directions `tr(Ω M′) ≤ tr(Ω M₀) + n max_u d(u)`. The tangent of the
//! criterion ([`crate::criterion::tangent_bound`]) makes that a bound of it. At the optimal approximate design both sides
//! are equal (`kiefer1960`).
//!
//! # The maximum of d over the sphere
//! Along a great circle, d is a trigonometric polynomial of degree 4 for sensors with equal gains and noise on
//! all axes. It lies between 0 and its maximum D. By Bernstein's inequality its second derivative is at most
//! `4² D/2`. A grid with a point within δ of every direction therefore misses at most `4 δ² D`. Degree 6 is
//! taken in place of 4, since gains differ a little.

use super::hold_information::{Gain, HoldInformation};
use crate::criterion::smooth_criterion::SmoothCriterion;
use crate::criterion::tangent_bound::Tangent;
use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

/// Degree of d along a great circle.
const DEGREE: f64 = 6.0;

/// A bound, and the directions that would raise it.
pub(super) struct Bound {
    /// `Φ(C′)` is at least this for any n allowed poses.
    pub(super) value: f64,
    /// Local maxima of d on the grid, the greatest first.
    pub(super) best: Vec<Vector3<f64>>,
}

/// The bound from the covariance C of an approximate design.
pub(super) fn bound(
    information: &HoldInformation,
    grid: &(Vec<Vector3<f64>>, f64),
    criterion: SmoothCriterion<'_>,
    c: &DMatrix<f64>,
    poses: usize,
) -> Bound {
    let tangent = Tangent::new(criterion, c);
    let (most, best) = greatest(&information.gain(&tangent.omega), grid);
    let value = tangent.bound(tangent.omega.dot(information.prior()) + poses as f64 * most);
    Bound { value, best }
}

/// An upper bound of d, and its local maxima on the grid.
fn greatest(gain: &Gain<'_>, (grid, radius): &(Vec<Vector3<f64>>, f64)) -> (f64, Vec<Vector3<f64>>) {
    let mut values: Vec<(f64, Vector3<f64>)> = grid.par_iter().map(|u| (gain.at(u), *u)).collect();
    values.sort_by(|one, other| other.0.total_cmp(&one.0));
    let most = values.first().map_or(0.0, |(value, _)| *value);
    // the greatest that are not close together
    let mut best: Vec<Vector3<f64>> = Vec::new();
    for (_, u) in values.iter().take_while(|(value, _)| *value > most * (1.0 - NEARLY)) {
        if best.len() < LOCAL && best.iter().all(|other| other.dot(u) < APART) {
            best.push(*u);
        }
    }
    (most / (1.0 - DEGREE * DEGREE * radius * radius / 4.0), best)
}

/// Share below the maximum of d down to which directions are of interest.
const NEARLY: f64 = 0.02;
/// Most of them.
const LOCAL: usize = 12;
/// Cosine of the angle between them.
const APART: f64 = 0.97;
