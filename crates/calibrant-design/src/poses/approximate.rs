//! The approximate design: the best directions with any shares, and the bound that it gives.
//!
//! The optimum has few directions, and is found by turns: a descent over directions and shares together, and
//! new directions where d is greatest. It ends once the bound is met.
//!
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
use super::problem::PoseProblem;
use super::result::PoseBound;
use super::spectral_projected_gradient::{Descent, Poses};
use crate::criterion::{SmoothCriterion, Tangent};
use calibrant_core::information::Criterion;
use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

/// The approximate design and its bound.
pub(super) struct Approximate {
    /// A lower bound of the criterion for any n allowed poses.
    pub(super) bound: f64,
    /// Directions and the number of poses at each.
    pub(super) poses: Poses,
}

impl Approximate {
    /// The bound, for a set of poses with this value.
    pub(super) fn bound_of(self, value: f64) -> PoseBound {
        let all: f64 = self.poses.shares.iter().sum();
        PoseBound {
            // rounding
            value: self.bound.min(value),
            directions: self.poses.directions,
            shares: self.poses.shares.iter().map(|share| share / all).collect(),
        }
    }
}

/// Rounds of descent and new directions.
const ROUNDS: usize = 25;
/// Cells along the edge of the coarse and the fine grid.
const COARSE: usize = 32;
const FINE: usize = 160;
/// Relative gap to the bound with which the search ends.
const GAP: f64 = 1e-4;
/// Iterations of a descent.
const ITERATIONS: usize = 300;
/// Share of the largest share below which a direction is dropped.
const NEGLIGIBLE: f64 = 1e-4;
/// Share of all poses that a new direction begins with.
const NEW: f64 = 0.02;
/// Exponents of the power means for E and M, one for each round; the last is kept.
const EXPONENTS: [f64; 4] = [8.0, 24.0, 72.0, 200.0];

/// Solves the approximate problem from these directions; `None` where they determine too little.
pub(super) fn approximate(
    problem: &PoseProblem,
    information: &HoldInformation,
    start: Vec<Vector3<f64>>,
) -> Option<Approximate> {
    let is_kinked = matches!(problem.criterion, Criterion::E(_) | Criterion::M(_));
    let (coarse, fine) = (problem.allowed.grid(COARSE), problem.allowed.grid(FINE));
    let count = start.len() as f64;
    let shares = vec![problem.poses as f64 / count; start.len()];
    let mut poses = Poses { directions: start, shares };
    let mut best: Option<Approximate> = None;
    for round in 0..ROUNDS {
        let exponent = EXPONENTS[round.min(EXPONENTS.len() - 1)];
        let criterion = SmoothCriterion { criterion: &problem.criterion, exponent };
        let descent = Descent {
            information,
            allowed: &problem.allowed,
            criterion,
            moves_shares: true,
            iterations: ITERATIONS,
        };
        poses = without_negligible(descent.run(poses)?);
        let c = poses.covariance(information)?;
        let found = bound(information, &coarse, criterion, &c, problem.poses);
        let value = problem.criterion.value(&c);
        let is_last = round + 1 == ROUNDS || (is_kinked && round + 1 == EXPONENTS.len());
        let finest = bound(information, &fine, criterion, &c, problem.poses).value;
        if best.as_ref().is_none_or(|best| finest > best.bound) {
            best = Some(Approximate { bound: finest, poses: poses.clone() });
        }
        if is_last || problem.criterion.gap(value, finest) < GAP * c.nrows() as f64 {
            break;
        }
        let all: f64 = poses.shares.iter().sum();
        for u in found.best {
            poses.directions.push(problem.allowed.nearest(&u));
            poses.shares.push(all * NEW);
        }
        let sum: f64 = poses.shares.iter().sum();
        poses.shares.iter_mut().for_each(|share| *share *= all / sum);
    }
    best
}

/// The poses without directions that have next to no share, and with directions that are equal taken together.
fn without_negligible(poses: Poses) -> Poses {
    let all: f64 = poses.shares.iter().sum();
    let most = poses.shares.iter().copied().fold(0.0, f64::max);
    let mut kept = Poses { directions: Vec::new(), shares: Vec::new() };
    for (u, share) in poses.directions.into_iter().zip(poses.shares) {
        if share < NEGLIGIBLE * most {
            continue;
        }
        match kept.directions.iter().position(|other| other.dot(&u) > 1.0 - 1e-6) {
            Some(k) => kept.shares[k] += share,
            None => {
                kept.directions.push(u);
                kept.shares.push(share);
            }
        }
    }
    let sum: f64 = kept.shares.iter().sum();
    kept.shares.iter_mut().for_each(|share| *share *= all / sum);
    kept
}

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
