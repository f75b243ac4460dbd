//! A motion as JSON: a row for each node.

use super::JerkControlledMotion;
use crate::form::vector_rows;
use crate::json::{flat, if_some};
use nalgebra::Vector3;

/// The nodes of a motion over the first axes, and what follows from them.
pub struct MotionTable<'a> {
    /// The motion.
    pub motion: &'a JerkControlledMotion,
    /// Number of axes.
    pub axes: usize,
    /// Standard deviation of each node acceleration, where it was estimated.
    pub acceleration_sd_mps2: Option<&'a [Vector3<f64>]>,
}

crate::json_object! {
    /// A motion: a row for each node.
    MotionTable<'_> as of {
        times_s: of.motion.times_s(),
        acceleration_mps2: vector_rows(of.motion.acceleration_mps2(), of.axes),
        acceleration_sd_mps2: if_some(of.acceleration_sd_mps2.map(|sd| vector_rows(sd, of.axes))),
        jerk_mps3: vector_rows(&of.motion.jerk_mps3(), of.axes),
        velocity_mps: vector_rows(&of.motion.velocity_mps(), of.axes),
        displacement_m: vector_rows(&of.motion.displacement_m(), of.axes),
    }
}

crate::json_object! {
    /// A motion of piecewise-linear acceleration.
    JerkControlledMotion as of {
        table: flat(MotionTable { motion: of, axes: of.axes, acceleration_sd_mps2: None }),
    }
}
