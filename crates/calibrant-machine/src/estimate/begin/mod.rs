//! Where the iteration begins: splines through the log, the placement of the recording, and the motion trusted.

mod initial;
mod knot_choice;
mod placement;
mod reference_fit;

pub(crate) use initial::{Initial, check_log, middle_s};
pub(crate) use knot_choice::{initial, trusted};
pub(crate) use placement::Placement;
pub use reference_fit::MotionOfLog;
pub(crate) use reference_fit::{covered, fitted};
