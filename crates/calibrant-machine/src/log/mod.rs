//! What the machine recorded of its own motion.

mod filled;
mod interpolated;
mod piecewise_linear;
mod quantisation;
mod reference_log;

pub use filled::leave_out_filled;
pub use interpolated::{RecoveredStream, recover_interpolated};
pub(crate) use quantisation::rounding_sd;
pub use quantisation::step_of;
pub use reference_log::{JointLog, PoseLog, ReferenceLog};
