//! The limits: on control points, and at times of a grid.

mod joint_limit;
mod kinematics;
mod linear;
mod pointwise;
mod sensor_body;
mod surroundings;
#[cfg(test)]
mod tests;

pub use joint_limit::JointLimit;
pub(crate) use kinematics::{PointVelocity, poses};
pub(crate) use linear::{Linear, least_slack};
pub(crate) use pointwise::{PointRows, PointWork, Pointwise};
pub use sensor_body::SensorBody;
pub use surroundings::Surroundings;
