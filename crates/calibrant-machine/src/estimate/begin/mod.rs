//! Where the iteration begins: splines through the log, the placement of the recording, and the motion trusted.

mod bridge;
mod initial;
mod knot_choice;
mod placement;
mod reference_fit;
mod refine;
mod suspects;

pub(crate) use bridge::bridge;
pub(crate) use initial::{Initial, check_log, middle_s};
pub(crate) use knot_choice::{initial, trusted};
pub(crate) use placement::Placement;
pub use reference_fit::MotionOfLog;
pub(crate) use reference_fit::{covered, fitted};
pub(crate) use refine::refined;
pub(crate) use suspects::suspect;
