//! What the machine recorded of its own motion.

mod joint_log;
mod pose_log;
mod reference_log;

pub use joint_log::JointLog;
pub use pose_log::PoseLog;
pub use reference_log::ReferenceLog;
