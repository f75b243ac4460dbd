//! What the machine recorded of its own motion.

mod interpolated;
mod piecewise_linear;
mod reference_log;

pub use interpolated::{RecoveredStream, recover_interpolated};
pub use reference_log::{JointLog, PoseLog, ReferenceLog};
