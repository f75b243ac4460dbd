//! The sheet of a trajectory: what it determines, its limits, the machine in motion, the search.

mod gain;
mod limits;
mod predicted;
mod sections;
mod sweep;

pub use sections::{trajectory_evaluation_sheet, trajectory_sheet};
pub use sweep::trajectory_sweep_sheet;
