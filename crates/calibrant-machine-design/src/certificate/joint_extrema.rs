//! Extrema of the joints' positions and derivatives.

use super::limit_proof::{Kept, LimitProof, ROUNDING, Running, TrajectoryLimit};
use crate::TrajectoryProblem;
use crate::motion::Knots;
use nalgebra::DMatrix;

/// The joints' limits.
pub(super) fn all(problem: &TrajectoryProblem<'_>, knots: Knots, controls: &DMatrix<f64>) -> Vec<LimitProof> {
    let h = knots.step_s;
    let mut proofs = Vec::new();
    for (j, limit) in problem.joints.iter().enumerate() {
        // how far beyond the middle of the positions, and the derivatives
        let middle = (limit.upper + limit.lower) / 2.0;
        let mut running = [Running::new(); 4];
        let mut position = (0.0, limit.upper);
        for i in 0..knots.intervals {
            let c = [0, 1, 2, 3].map(|r| controls[(i + r, j)]);
            let second = [c[0] - 2.0 * c[1] + c[2], c[1] - 2.0 * c[2] + c[3]];
            // q̇ h = v₀ + s₀ u + (s₁ − s₀) u²/2
            let (v0, s0, s1) = ((c[2] - c[0]) / 2.0, second[0], second[1]);
            let q = |u: f64| {
                let q0 = (c[0] + 4.0 * c[1] + c[2]) / 6.0;
                q0 + u * (v0 + u * (s0 / 2.0 + u * (s1 - s0) / 6.0))
            };
            let t = |u: f64| (i as f64 + u) * h;
            let mut places = vec![0.0, 1.0];
            places.extend(roots((s1 - s0) / 2.0, s0, v0));
            for &u in &places {
                let away = (q(u) - middle).abs();
                if away > running[0].peak {
                    position = (q(u), if q(u) < middle { limit.lower } else { limit.upper });
                }
                running[0].see(away, t(u));
            }
            let mut fastest = vec![0.0, 1.0];
            fastest.extend(roots(0.0, s1 - s0, s0));
            for u in fastest {
                running[1].see((v0 + s0 * u + (s1 - s0) * u * u / 2.0).abs() / h, t(u));
            }
            for (u, s) in [(0.0, s0), (1.0, s1)] {
                running[2].see(s.abs() / (h * h), t(u));
            }
            running[3].see((s1 - s0).abs() / h.powi(3), t(0.0));
        }
        let allowed = [(limit.upper - limit.lower) / 2.0, limit.velocity, limit.acceleration, limit.jerk];
        for (running, allowed) in running.iter_mut().zip(allowed) {
            if running.peak > allowed * (1.0 + ROUNDING) {
                running.kept = Kept::Broken;
            }
        }
        let kinds = [
            TrajectoryLimit::Position(j),
            TrajectoryLimit::Velocity(j),
            TrajectoryLimit::Acceleration(j),
            TrajectoryLimit::Jerk(j),
        ];
        for ((running, kind), allowed) in running.iter().zip(kinds).zip(allowed) {
            if allowed.is_finite() {
                proofs.push(running.proof(kind, allowed));
            }
        }
        if let Some(of) = proofs.iter_mut().find(|proof| proof.limit == TrajectoryLimit::Position(j)) {
            (of.peak, of.allowed) = position;
        }
    }
    proofs
}

/// Zeros of `a u² + b u + c` between 0 and 1.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let all = if a.abs() <= 1e-14 * (b.abs() + c.abs()) {
        vec![-c / b]
    } else {
        let root = (b * b - 4.0 * a * c).sqrt();
        // without cancellation
        let q = -0.5 * (b + if b < 0.0 { -root } else { root });
        vec![q / a, c / q]
    };
    all.into_iter().filter(|u| (0.0..=1.0).contains(u)).collect()
}
