//! What the machine recorded of its own motion.

mod interpolated;
mod joint_log;
mod knot_frequency;
mod piecewise_linear;
mod pose_log;
mod reference_log;

pub use interpolated::{RecoveredStream, recover_interpolated};
pub use joint_log::JointLog;
pub use pose_log::PoseLog;
pub use reference_log::ReferenceLog;
