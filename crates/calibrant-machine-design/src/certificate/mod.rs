//! Do the limits hold for all times? Proofs between samples, by bisection.
//!
//! # Joints
//! Position, velocity, acceleration and jerk of a cubic spline have their extrema at knots, or where a polynomial of degree one or two is zero: they are exact.
//!
//! # Distances
//! With the speeds `v_j` of the joints in an interval (at most those of its control points) and the reach `r_j` of the farther body about joint `j`, two bodies approach by
//! `Σ v_j r_j` at most, over the joints between them. Between times `t₀` and `t₁` the distance is at least
//!
//! ```text
//! (d₀ + d₁ − v (t₁ − t₀))/2
//! ```
//!
//! # Readings and speeds
//! A function differs from its chord by `Δ²/8 · max |ÿ|` at most. The bounds of second derivatives follow from a recursion of the norms of `ω, ω̇, ω̈, ω⃛`: a vector of
//! length `r` that is fixed in a frame has derivatives of at most `b_m r`, with
//!
//! ```text
//! b₁ = |ω|     b₂ = |ω̇| + |ω|²     b₃ = |ω̈| + 3|ω||ω̇| + |ω|³     b₄ = |ω⃛| + 4|ω||ω̈| + 3|ω̇|² + 6|ω|²|ω̇| + |ω|⁴
//! ```
//!
//! and a joint adds `u q̇` to the rate, of which the same holds. Then `|f̈_i| ≤ |p⁗| + 2|ω||p⃛| + b₂ (|p̈| + g)`, `|ẅ_i| ≤ |ω̈| + |ω||ω̇|`, `|v̈| ≤ |p⃛|`.
//!
//! # Speed near the ends of joints
//! `k (upper − q) − (q̇ + o)²` is a polynomial of degree four between knots: it is positive where its Bernstein coefficients are.

mod derivative_bounds;
mod distances;
mod joint_extrema;
mod limit_proof;
mod near_ends;
mod readings;
mod rest;
#[cfg(test)]
mod tests;

pub use limit_proof::{Kept, LimitProof, TrajectoryLimit};

use crate::TrajectoryProblem;
use crate::motion::Knots;
use nalgebra::DMatrix;

/// All limits of a motion.
pub(crate) fn certify(
    problem: &TrajectoryProblem<'_>,
    knots: Knots,
    controls: &DMatrix<f64>,
) -> Vec<LimitProof> {
    let mut proofs = joint_extrema::all(problem, knots, controls);
    proofs.extend(rest::broken(problem, knots, controls));
    proofs.extend(near_ends::all(problem, knots, controls));
    proofs.extend(readings::all(problem, knots, controls));
    proofs.extend(distances::all(problem, knots, controls));
    proofs
}
