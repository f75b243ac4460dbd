//! Bounds of the derivatives of rate and position along the chain, on an interval: see the head of the module.

use crate::TrajectoryProblem;
use crate::motion::Knots;
use nalgebra::{DMatrix, Vector3};

/// Bounds on an interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct DerivativeBounds {
    /// `|f̈_i|`.
    pub(super) force: f64,
    /// `|ẅ_i|`.
    pub(super) rate: f64,
    /// `|v̈|` of a point of the tip, and `|ω̈|`.
    pub(super) speed: [f64; 2],
}

/// Norms of the rate and its three derivatives.
#[derive(Clone, Copy, Default)]
struct Turning([f64; 4]);

impl Turning {
    /// `1, b₁ … b₄`.
    fn of_fixed(&self) -> [f64; 5] {
        let [w, w1, w2, w3] = self.0;
        [
            1.0,
            w,
            w1 + w * w,
            w2 + 3.0 * w * w1 + w.powi(3),
            w3 + 4.0 * w * w2 + 3.0 * w1 * w1 + 6.0 * w * w * w1 + w.powi(4),
        ]
    }
}

/// Derivatives 2 to 4 of a position, to which vectors are added.
type Moving = [f64; 3];

/// Adds a vector along an axis that is fixed in a frame, whose length has these derivatives.
fn add(moving: &mut Moving, turning: &Turning, length: [f64; 4]) {
    /// Binomial coefficients of the second to fourth derivative.
    const BINOMIAL: [[f64; 4]; 3] = [[1.0, 2.0, 1.0, 0.0], [1.0, 3.0, 3.0, 1.0], [1.0, 4.0, 6.0, 4.0]];
    let b = turning.of_fixed();
    for (m, moving) in moving.iter_mut().enumerate() {
        for (i, binomial) in BINOMIAL[m].iter().enumerate().take(m + 3) {
            *moving += binomial * b[m + 2 - i] * length[i];
        }
    }
}

/// The bounds of interval `i`, for a point at `point` behind the last joint.
pub(super) fn on_interval(
    problem: &TrajectoryProblem<'_>,
    knots: Knots,
    controls: &DMatrix<f64>,
    i: usize,
    point: &Vector3<f64>,
) -> DerivativeBounds {
    let h = knots.step_s;
    let (mut turning, mut moving) = (Turning::default(), [0.0; 3]);
    for (j, joint) in problem.chain.joints.iter().enumerate() {
        add(&mut moving, &turning, [joint.origin.translation.vector.norm(), 0.0, 0.0, 0.0]);
        let c = [0, 1, 2, 3].map(|r| controls[(i + r, j)]);
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let first = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
        let second = [first[1] - first[0], first[2] - first[1]];
        let (v, a, jerk) =
            (largest(&first) / h, largest(&second) / (h * h), (second[1] - second[0]).abs() / h.powi(3));
        if joint.kind.turns() {
            let b = turning.of_fixed();
            let [w, w1, w2, w3] = turning.0;
            turning = Turning([
                w + v,
                w1 + b[1] * v + a,
                w2 + b[2] * v + 2.0 * b[1] * a + jerk,
                w3 + b[3] * v + 3.0 * b[2] * a + 3.0 * b[1] * jerk,
            ]);
        } else {
            add(&mut moving, &turning, [largest(&c), v, a, jerk]);
        }
    }
    add(&mut moving, &turning, [point.norm(), 0.0, 0.0, 0.0]);
    let ([w, w1, w2, _], [p2, p3, p4]) = (turning.0, moving);
    let felt = p2 + problem.setup.gravity_mps2.abs();
    DerivativeBounds { force: p4 + 2.0 * w * p3 + (w1 + w * w) * felt, rate: w2 + w * w1, speed: [p3, w2] }
}
