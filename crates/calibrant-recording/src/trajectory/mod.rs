//! Trajectories of machines, in the files that controllers take. All hold one cubic spline: at its knots, or by its control points.

mod goal;
mod knots;
mod table;
mod urscript;

pub use goal::{MOST_POINTS, goal_text, write_goal};
pub(crate) use knots::{between_knots, spline_through, spline_through_velocities};
pub use table::{Trajectory, read_trajectory, write_trajectory};
pub use urscript::{urscript_text, write_urscript};
