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
mod near_ends;
mod readings;
#[cfg(test)]
mod tests;

use crate::TrajectoryProblem;
use crate::motion::Knots;
use nalgebra::DMatrix;

/// A limit of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrajectoryLimit {
    /// Position of a joint, rad or m.
    Position(usize),
    /// Speed of a joint.
    Velocity(usize),
    /// Acceleration of a joint.
    Acceleration(usize),
    /// Jerk of a joint.
    Jerk(usize),
    /// Speed of a joint near its ends.
    SpeedNearEnds(usize),
    /// Specific force on an axis of the sensor, m/s².
    Force(usize),
    /// Angular rate about an axis of the sensor, rad/s.
    Rate(usize),
    /// Speed of the tip frame, m/s.
    TipSpeed,
    /// Speed of the sensor's body, m/s.
    SensorSpeed,
    /// Distance of a pair of bodies, m.
    Clearance(usize),
}

/// How far a trajectory goes towards a limit, and whether it keeps it for all times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitProof {
    /// The limit.
    pub limit: TrajectoryLimit,
    /// The value nearest to it that was seen.
    pub peak: f64,
    /// The limit's value there.
    pub allowed: f64,
    /// Share of the limit that is used; of a distance, the clearance over the distance.
    pub used: f64,
    /// Time of the peak, s.
    pub time_s: f64,
    /// Is it kept?
    pub kept: Kept,
}

/// Whether a limit is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// For all times: proved.
    Proved,
    /// At all times that were looked at; the proof came to its end.
    Unproved,
    /// Not.
    Broken,
}

/// Limits are broken where they are exceeded by more than this part: rounding of control points that go through files.
pub(crate) const ROUNDING: f64 = 1e-9;

/// All limits of a motion.
pub(crate) fn certify(
    problem: &TrajectoryProblem<'_>,
    knots: Knots,
    controls: &DMatrix<f64>,
) -> Vec<LimitProof> {
    let mut proofs = joint_extrema::all(problem, knots, controls);
    proofs.extend(near_ends::all(problem, knots, controls));
    proofs.extend(readings::all(problem, knots, controls));
    proofs.extend(distances::all(problem, knots, controls));
    proofs
}

/// Shortest part of an interval that a bisection looks at.
const SHORTEST: f64 = 1e-6;

/// A proof under way: the peak so far, and what is known.
#[derive(Debug, Clone, Copy)]
struct Running {
    peak: f64,
    time_s: f64,
    kept: Kept,
}

impl Running {
    fn new() -> Self {
        Self { peak: f64::NEG_INFINITY, time_s: 0.0, kept: Kept::Proved }
    }

    /// A value, larger being nearer to the limit.
    fn see(&mut self, value: f64, time_s: f64) {
        if value > self.peak {
            (self.peak, self.time_s) = (value, time_s);
        }
    }

    fn breaks(&mut self) {
        self.kept = Kept::Broken;
    }

    fn give_up(&mut self) {
        if self.kept == Kept::Proved {
            self.kept = Kept::Unproved;
        }
    }

    fn proof(&self, limit: TrajectoryLimit, allowed: f64) -> LimitProof {
        let used = self.peak / allowed;
        LimitProof { limit, peak: self.peak, allowed, used, time_s: self.time_s, kept: self.kept }
    }
}
