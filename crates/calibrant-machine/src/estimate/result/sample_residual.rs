//! The residual of one sample.

use nalgebra::Vector3;

/// The residual of one sample, in the unit of the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleResidual {
    /// Time of the motion, s.
    pub time_s: f64,
    /// Reading less what the motion says.
    pub value: Vector3<f64>,
    /// Standard deviation of the sample's noise, which may grow with the motion.
    pub sd: Vector3<f64>,
}
