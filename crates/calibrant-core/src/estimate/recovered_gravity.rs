//! Gravity in a commanded motion, as it was estimated with the parameters.

use crate::motion::MotionGravity;
use crate::sensor::Axis;
use nalgebra::{Matrix3, Vector3};

/// Gravity that was given, and its offset: a nuisance with a prior of zero mean, estimated and marginalised.
///
/// Only a prior of the biases tells the offset from them. Without one, its estimate is zero and its covariance
/// that of its prior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecoveredGravity {
    /// Gravity as it was given.
    pub gravity: MotionGravity,
    /// Estimate of the offset, m/s².
    pub offset_mps2: Vector3<f64>,
    /// Its covariance, (m/s²)².
    pub offset_covariance: Matrix3<f64>,
}

impl RecoveredGravity {
    /// Specific force of the sensor at rest, m/s².
    #[must_use]
    pub fn force_mps2(&self) -> Vector3<f64> {
        self.gravity.force_mps2 + self.offset_mps2
    }

    /// The tilt about each axis, rad.
    #[must_use]
    pub fn tilt_rad(&self) -> Vector3<f64> {
        self.gravity.tilt(&self.offset_mps2)
    }

    /// Name, estimate and standard deviation of the tilt about each level axis, rad: `tilt.x`. Axes that gravity lies
    /// along have none; without any tilt there are none.
    #[must_use]
    pub fn tilts(&self) -> Vec<(String, f64, f64)> {
        let (tilt, sd) = (self.tilt_rad(), self.tilt_sd_rad());
        let level = self.gravity.tilt_covariance(&self.gravity.offset_covariance()).diagonal();
        let is_level = |axis: &Axis| level[axis.index()] > 1e-9 * level.amax();
        let named = |axis: Axis| (format!("tilt.{axis}"), tilt[axis.index()], sd[axis.index()]);
        Axis::ALL.into_iter().filter(is_level).map(named).collect()
    }

    /// Standard deviation of the tilt about each axis, rad; 0 about an axis that gravity lies along.
    #[must_use]
    pub fn tilt_sd_rad(&self) -> Vector3<f64> {
        self.gravity
            .tilt_covariance(&self.offset_covariance)
            .diagonal()
            .map(|variance| variance.max(0.0).sqrt())
    }
}
