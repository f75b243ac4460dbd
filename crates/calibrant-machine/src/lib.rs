//! An inertial sensor carried by a machine that turns it: an arm, a rate table, a gantry, or any body that a tracker sees.
//!
//! The machine is the reference: a log of its joints, or of the pose of the body. From it follows what the sensor should have read.

pub mod chain;
pub mod estimate;
pub mod log;
pub mod reference;
pub mod simulate;
pub mod spline;
