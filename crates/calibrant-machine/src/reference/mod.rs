//! The motion of the reference as the estimator sees it: what a sensor on it feels at any time, with all derivatives.

mod felt;
mod joint_motion;
mod motion;
mod pose_motion;

pub use felt::{Felt, MotionColumns};
pub use joint_motion::JointMotion;
pub use motion::{Carrier, Motion, Posture};
pub(crate) use pose_motion::POSE_UNKNOWNS;
pub use pose_motion::PoseMotion;
