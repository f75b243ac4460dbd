//! The motion of the reference as the estimator sees it: what a sensor on it feels at any time, with all derivatives.

mod felt;
mod motion;
mod mount;
mod pose_motion;

pub use felt::{Felt, MotionColumns};
pub use motion::{Carrier, Motion};
pub use mount::{BodyMotion, SensorMount};
pub use pose_motion::PoseMotion;
