//! The motion of a frame, and how a fixed transform passes it on.

use nalgebra::{Matrix3, Vector3};

/// What a sensor in a frame feels, and the angular acceleration that frames behind it need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameMotion {
    /// Specific force `Rᵀ(p̈ − γ)` in the axes of the frame, m/s².
    pub specific_force: Vector3<f64>,
    /// Angular rate in the axes of the frame, rad/s.
    pub rate: Vector3<f64>,
    /// Angular acceleration in the axes of the frame, rad/s².
    pub angular_acceleration: Vector3<f64>,
}

impl FrameMotion {
    /// A frame that does not move, with the gravity vector in its axes, m/s².
    #[must_use]
    pub fn at_rest(gravity: &Vector3<f64>) -> Self {
        Self { specific_force: -gravity, rate: Vector3::zeros(), angular_acceleration: Vector3::zeros() }
    }

    /// Derivative of the specific force at `ρ` with respect to `ρ`: `[ω̇]× + [ω]×²`, 1/s².
    #[must_use]
    pub fn force_gradient(&self) -> Matrix3<f64> {
        let cross = self.rate.cross_matrix();
        self.angular_acceleration.cross_matrix() + cross * cross
    }

    /// The motion at `ρ` in the same axes.
    pub(super) fn shifted(&self, rho: &Vector3<f64>) -> Self {
        let (w, wd) = (&self.rate, &self.angular_acceleration);
        Self { specific_force: self.specific_force + wd.cross(rho) + w.cross(&w.cross(rho)), ..*self }
    }

    /// The motion in turned axes: `C` gives this frame from the new one.
    pub(super) fn turned(&self, c: &Matrix3<f64>) -> Self {
        Self {
            specific_force: c.tr_mul(&self.specific_force),
            rate: c.tr_mul(&self.rate),
            angular_acceleration: c.tr_mul(&self.angular_acceleration),
        }
    }
}
