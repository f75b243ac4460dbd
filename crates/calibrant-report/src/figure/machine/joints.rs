//! Positions and speeds of the joints over time.

use crate::figure::Figure;
use crate::figure::colour;
use crate::figure::panel::{Panel, Series};
use calibrant_machine::spline::VectorSpline;
use calibrant_machine_design::TrajectoryProblem;

/// Points of a curve in each interval of the spline.
const POINTS: usize = 8;

/// One panel for each joint, with its position, its speed, and the limits of the speed.
pub(crate) fn joint_figure(motion: &VectorSpline, problem: &TrajectoryProblem<'_>) -> Figure {
    let knots = motion.knots;
    let count = knots.intervals * POINTS;
    let times: Vec<f64> =
        (0..=count).map(|k| knots.start_s + knots.step_s * k as f64 / POINTS as f64).collect();
    let panels = problem.chain.joints.iter().zip(&problem.joints).enumerate().map(|(j, (joint, limit))| {
        let points = |derivative: usize| times.iter().map(|t| (*t, motion.at(*t, derivative)[j])).collect();
        let unit = if joint.kind.turns() { "rad, rad/s" } else { "m, m/s" };
        Panel::new(&joint.name, "time (s)", unit)
            .with(Series::line("position", colour::BLUE, points(0)))
            .with(Series::dashed("speed", colour::VERMILLION, points(1)))
            .with_limits(limit.velocity)
    });
    let caption = "Good: each joint uses its range and its speed, and none moves like another. The dashed black lines are the largest speed.";
    Figure::new("Positions and speeds of the joints", panels.collect(), caption)
}
