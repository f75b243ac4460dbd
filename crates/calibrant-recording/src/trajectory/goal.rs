//! `follow_joint_trajectory.yaml`: a goal of ROS 2's `control_msgs/action/FollowJointTrajectory`.
//!
//! Its points have positions and velocities at the knots. A controller joins them by cubic polynomials, and so follows the spline exactly.

use super::Trajectory;
use crate::files::atomic_output::write_text;
use calibrant_core::error::Result;
use std::path::Path;

/// Most points that all controllers take: MotoROS2 has this limit.
pub const MOST_POINTS: usize = 200;

/// Time after the end at which a controller may still be on its way, s.
const LATE_S: u32 = 1;

/// The text of the goal, as `ros2 action send_goal` takes it.
///
/// # Examples
/// ```
/// use calibrant_recording::{Trajectory, goal_text};
/// use calibrant_machine::spline::{Degree, UniformKnots, VectorSpline};
/// let knots = UniformKnots { start_s: 0.0, step_s: 0.5, intervals: 4, degree: Degree::Cubic };
/// let spline = VectorSpline { knots, dimension: 1, controls: vec![0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0] };
/// let text = goal_text(&Trajectory { names: vec!["elbow".into()], turns: vec![true], spline });
/// assert!(text.contains("time_from_start: {sec: 0, nanosec: 500000000}"));
/// ```
#[must_use]
pub fn goal_text(trajectory: &Trajectory) -> String {
    let Trajectory { names, spline, .. } = trajectory;
    let names: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    let mut text = String::new();
    let mut line = |line: String| text.extend([line.as_str(), "\n"]);
    line("trajectory:".into());
    line(format!("  joint_names: [{}]", names.join(", ")));
    line("  points:".into());
    for t in trajectory.times_s() {
        let numbers = |derivative: usize| {
            // YAML takes 1e-7 for a word
            let all: Vec<String> = spline.at(t, derivative).iter().map(|of| format!("{of:.12}")).collect();
            all.join(", ")
        };
        let nanoseconds = ((t - spline.knots.start_s) * 1e9).round() as u64;
        let (sec, nanosec) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
        line(format!("  - positions: [{}]", numbers(0)));
        line(format!("    velocities: [{}]", numbers(1)));
        line(format!("    time_from_start: {{sec: {sec}, nanosec: {nanosec}}}"));
    }
    line(format!("goal_time_tolerance: {{sec: {LATE_S}, nanosec: 0}}"));
    text
}

/// Writes the goal.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_goal(path: &Path, trajectory: &Trajectory) -> Result<()> {
    write_text(path, &goal_text(trajectory))
}

#[cfg(test)]
mod tests {
    use super::super::knots::tests::wild;
    use super::*;

    /// The numbers in the brackets of lines that begin so.
    fn lists(text: &str, key: &str) -> Vec<Vec<f64>> {
        let of = |line: &str| {
            let inner = line.trim().trim_start_matches("- ").strip_prefix(key)?.trim_matches(['[', ']']);
            inner.split(", ").map(|number| number.parse().ok()).collect()
        };
        text.lines().filter_map(of).collect()
    }

    #[test]
    fn hermite_polynomials_between_the_points_are_the_spline() {
        let spline = wild();
        let names = vec!["one".to_owned(), "two".to_owned()];
        let text = goal_text(&Trajectory { names, turns: vec![true, true], spline: spline.clone() });
        let (q, v) = (lists(&text, "positions: "), lists(&text, "velocities: "));
        assert_eq!((q.len(), v.len()), (26, 26));
        let h = 0.2;
        for (k, u) in (0..25).flat_map(|k| [0.1, 0.37, 0.5, 0.93].map(|u| (k, u))) {
            for joint in 0..2 {
                let (a, b) = (q[k][joint], q[k + 1][joint]);
                let (da, db) = (h * v[k][joint], h * v[k + 1][joint]);
                let hermite = (1.0 + 2.0 * u) * (1.0 - u) * (1.0 - u) * a
                    + u * (1.0 - u) * (1.0 - u) * da
                    + u * u * (3.0 - 2.0 * u) * b
                    + u * u * (u - 1.0) * db;
                let wanted = spline.at(h * (k as f64 + u), 0)[joint];
                assert!((hermite - wanted).abs() < 1e-9, "{k} {u}: {hermite} against {wanted}");
            }
        }
    }
}
