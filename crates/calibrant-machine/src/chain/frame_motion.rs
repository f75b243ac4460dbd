//! The motion of a frame, how a fixed transform passes it on, and what a sensor there takes from it.

use nalgebra::{Matrix3, SMatrix, Vector3, Vector6};

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

/// Derivative of a sensor's specific force `f` and rate `w` with respect to the motion `(a, ω, ω̇)` of a frame before it.
///
/// ```text
///        a    ω    ω̇
/// f  [   R    F    G  ]
/// w  [   0    R    0  ]
/// ```
///
/// `R` gives the sensor's axes from those of the frame. `w` depends on `ω` as `f` depends on `a`: both only turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorGain {
    /// `R`.
    pub sensor_from_frame: Matrix3<f64>,
    /// `F`, m/s.
    pub force_of_rate: Matrix3<f64>,
    /// `G`, m.
    pub force_of_angular_acceleration: Matrix3<f64>,
}

impl SensorGain {
    /// The gain of the sensor itself.
    #[must_use]
    pub fn identity() -> Self {
        let zero = Matrix3::zeros();
        Self {
            sensor_from_frame: Matrix3::identity(),
            force_of_rate: zero,
            force_of_angular_acceleration: zero,
        }
    }

    /// The change of `(f, w)` for a change of the motion.
    #[must_use]
    pub fn reading(
        &self,
        specific_force: &Vector3<f64>,
        rate: &Vector3<f64>,
        angular_acceleration: &Vector3<f64>,
    ) -> Vector6<f64> {
        let force = self.sensor_from_frame * specific_force
            + self.force_of_rate * rate
            + self.force_of_angular_acceleration * angular_acceleration;
        let rate = self.sensor_from_frame * rate;
        Vector6::new(force.x, force.y, force.z, rate.x, rate.y, rate.z)
    }

    /// All of it: rows `f`, `w`; columns `a`, `ω`, `ω̇`.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<f64, 6, 9> {
        let mut all = SMatrix::<f64, 6, 9>::zeros();
        all.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.sensor_from_frame);
        all.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.force_of_rate);
        all.fixed_view_mut::<3, 3>(0, 6).copy_from(&self.force_of_angular_acceleration);
        all.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.sensor_from_frame);
        all
    }

    /// The gain of the frame before a turn by `C`.
    pub(super) fn before_turn(&self, c: &Matrix3<f64>) -> Self {
        let turned = c.transpose();
        Self {
            sensor_from_frame: self.sensor_from_frame * turned,
            force_of_rate: self.force_of_rate * turned,
            force_of_angular_acceleration: self.force_of_angular_acceleration * turned,
        }
    }

    /// The gain of the frame before a shift by `ρ`, which moves with `before`.
    pub(super) fn before_shift(&self, rho: &Vector3<f64>, before: &FrameMotion) -> Self {
        let w = &before.rate;
        // ∂(ω×(ω×ρ))/∂ω
        let centripetal =
            w * rho.transpose() + Matrix3::from_diagonal_element(w.dot(rho)) - rho * w.transpose() * 2.0;
        Self {
            sensor_from_frame: self.sensor_from_frame,
            force_of_rate: self.force_of_rate + self.sensor_from_frame * centripetal,
            force_of_angular_acceleration: self.force_of_angular_acceleration
                - self.sensor_from_frame * rho.cross_matrix(),
        }
    }

    /// Derivative of the reading with respect to a turn of the frame about its own axes, where its motion is `at`: 3×3 of `f`, 3×3 of `w`.
    pub(super) fn of_turn(&self, at: &FrameMotion) -> [Matrix3<f64>; 2] {
        let of_rate = self.sensor_from_frame * at.rate.cross_matrix();
        let of_force = self.sensor_from_frame * at.specific_force.cross_matrix()
            + self.force_of_rate * at.rate.cross_matrix()
            + self.force_of_angular_acceleration * at.angular_acceleration.cross_matrix();
        [of_force, of_rate]
    }
}
