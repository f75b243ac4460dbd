//! What the machine recorded of its own motion.

mod interpolated;
mod piecewise_linear;
mod quantisation;
mod reference_log;

pub use interpolated::{RecoveredStream, recover_interpolated};
pub(crate) use quantisation::rounding_sd;
pub use quantisation::step_of;
pub use reference_log::{JointLog, PoseLog, ReferenceLog};
