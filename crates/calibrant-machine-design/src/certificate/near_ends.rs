//! Speeds near the ends of joints: polynomials of degree four.

use super::limit_proof::{Kept, LimitProof, MOST_PARTS, ROUNDING, Running, TrajectoryLimit};
use crate::TrajectoryProblem;
use crate::motion::Knots;
use calibrant_machine::chain::SpeedNearEnds;
use nalgebra::DMatrix;

/// Halvings of an interval at most.
const HALVINGS: usize = 30;

/// All joints that have such a limit.
pub(super) fn all(problem: &TrajectoryProblem<'_>, knots: Knots, controls: &DMatrix<f64>) -> Vec<LimitProof> {
    let of_joint = |(j, limit): (usize, &crate::JointLimit)| {
        let near_ends = limit.near_ends?;
        let mut running = Running::new();
        for i in 0..knots.intervals {
            let c = [0, 1, 2, 3].map(|r| controls[(i + r, j)]);
            for upward in [true, false] {
                let piece = Piece::new(c, knots.step_s, &near_ends, upward);
                let start_s = i as f64 * knots.step_s;
                piece.prove(&mut running, (start_s, knots.step_s), HALVINGS, &mut { MOST_PARTS });
            }
        }
        Some(running.proof(TrajectoryLimit::SpeedNearEnds(j), 1.0))
    };
    problem.joints.iter().enumerate().filter_map(of_joint).collect()
}

/// One side of the limit on a part of an interval: Bernstein coefficients of the room to the end `k (upper − q)` (degree 3) and of `q̇ + o` and `q̇` (degree 2).
#[derive(Clone, Copy)]
struct Piece {
    room: [f64; 4],
    fast: [f64; 3],
    speed: [f64; 3],
}

impl Piece {
    fn new(c: [f64; 4], h: f64, limit: &SpeedNearEnds, upward: bool) -> Self {
        // Bernstein coefficients of a uniform cubic B-spline's piece, and of its derivative
        let q = [
            (c[0] + 4.0 * c[1] + c[2]) / 6.0,
            (2.0 * c[1] + c[2]) / 3.0,
            (c[1] + 2.0 * c[2]) / 3.0,
            (c[1] + 4.0 * c[2] + c[3]) / 6.0,
        ];
        let sign = if upward { 1.0 } else { -1.0 };
        let speed = [0, 1, 2].map(|k| sign * 3.0 * (q[k + 1] - q[k]) / h);
        let room = q.map(|q| limit.slope * if upward { limit.upper - q } else { q - limit.lower });
        Self { room, fast: speed.map(|speed| speed + limit.offset), speed }
    }

    /// Is the joint moving away, or slow enough, all along?
    fn is_kept(&self) -> bool {
        if self.speed.iter().all(|speed| *speed <= 0.0) {
            return true;
        }
        let [r0, r1, r2, r3] = self.room;
        let raised = [r0, (r0 + 3.0 * r1) / 4.0, (r1 + r2) / 2.0, (3.0 * r2 + r3) / 4.0, r3];
        let [a, b, c] = self.fast;
        let square = [a * a, a * b, (a * c + 2.0 * b * b) / 3.0, b * c, c * c];
        raised.iter().zip(square).all(|(room, square)| *room >= square)
    }

    /// Both halves (de Casteljau).
    fn halves(&self) -> [Self; 2] {
        let [a, b] = [false, true].map(|second| Self {
            room: half(self.room, second),
            fast: half(self.fast, second),
            speed: half(self.speed, second),
        });
        [a, b]
    }

    fn prove(
        &self,
        running: &mut Running,
        (start_s, length_s): (f64, f64),
        halvings: usize,
        parts: &mut usize,
    ) {
        for (room, speed, fast, t) in [
            (self.room[0], self.speed[0], self.fast[0], start_s),
            (self.room[3], self.speed[2], self.fast[2], start_s + length_s),
        ] {
            // the part of the limit that is used: the speed over what is allowed there
            let allowed = room.max(0.0).sqrt() - (fast - speed);
            if speed > 0.0 {
                let used = if allowed > 0.0 { speed / allowed } else { f64::INFINITY };
                running.see(used, t);
                if used > 1.0 + 1e3 * ROUNDING {
                    running.kept = Kept::Broken;
                }
            } else {
                running.see(0.0, t);
            }
        }
        if self.is_kept() || running.kept == Kept::Broken {
            return;
        }
        *parts = parts.saturating_sub(1);
        if halvings == 0 || *parts == 0 {
            return running.give_up();
        }
        let [first, second] = self.halves();
        let half_s = length_s / 2.0;
        first.prove(running, (start_s, half_s), halvings - 1, parts);
        second.prove(running, (start_s + half_s, half_s), halvings - 1, parts);
    }
}

/// Bernstein coefficients of the first or second half.
fn half<const N: usize>(coefficients: [f64; N], second: bool) -> [f64; N] {
    let mut triangle = coefficients;
    let mut out = [0.0; N];
    for level in 0..N {
        out[if second { N - 1 - level } else { level }] =
            if second { triangle[N - 1 - level] } else { triangle[0] };
        for k in 0..N - 1 - level {
            triangle[k] = (triangle[k] + triangle[k + 1]) / 2.0;
        }
    }
    out
}
