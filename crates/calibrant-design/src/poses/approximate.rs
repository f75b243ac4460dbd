//! The approximate design: the best directions with any shares, and the bound that it gives.
//!
//! The optimum has few directions, and is found by turns: a descent over directions and shares together, and
//! new directions where d is greatest. It ends once the bound is met.

use super::bound::bound;
use super::hold_information::HoldInformation;
use super::problem::PoseProblem;
use super::result::PoseBound;
use super::spectral_projected_gradient::{Descent, Poses};
use crate::criterion::smooth_criterion::SmoothCriterion;
use calibrant_core::information::Criterion;
use nalgebra::Vector3;

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
