//! The sheet of a trajectory: what it determines, its limits, the machine in motion, the search.

mod limits;
mod predicted;
mod sections;

pub use sections::{trajectory_evaluation_sheet, trajectory_sheet};
