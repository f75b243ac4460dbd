//! Does the motion begin and end at rest? A controller joins it to a machine that stands still.

use super::limit_proof::{Kept, LimitProof, TrajectoryLimit};
use crate::TrajectoryProblem;
use crate::motion::Knots;
use nalgebra::DMatrix;

/// Speed at an end, in parts of the joint's top speed, that is rounding of a file.
const ROUNDED: f64 = 1e-4;

/// The ends at which a joint moves. There is no row for a joint that rests at both.
pub(super) fn broken(
    problem: &TrajectoryProblem<'_>,
    knots: Knots,
    controls: &DMatrix<f64>,
) -> Vec<LimitProof> {
    let (h, last) = (knots.step_s, knots.intervals);
    let speed = |i: usize, j: usize| ((controls[(i + 2, j)] - controls[(i, j)]) / (2.0 * h)).abs();
    let one = |j: usize| {
        let ends = [(0.0, speed(0, j)), (knots.duration_s(), speed(last, j))];
        let (time_s, peak) = ends.into_iter().max_by(|one, other| one.1.total_cmp(&other.1))?;
        let used = peak / problem.joints[j].velocity;
        let limit = TrajectoryLimit::Rest(j);
        (used > ROUNDED).then_some(LimitProof { limit, peak, allowed: 0.0, used, time_s, kept: Kept::Broken })
    };
    (0..controls.ncols()).filter_map(one).collect()
}
