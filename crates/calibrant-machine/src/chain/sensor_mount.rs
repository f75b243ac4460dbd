//! How the sensor sits on the body that carries it.

use super::{FrameMotion, SensorGain};
use nalgebra::{Matrix6x3, UnitQuaternion, Vector3};

/// Place and orientation of a sensor on the tip of a chain, or on a body that a tracker sees.
///
/// ```text
/// f = R_tsᵀ (a + ω̇×r + ω×(ω×r))        w = R_tsᵀ ω
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorMount {
    /// Lever arm `r`: position of the sensor in the axes of the tip, m.
    pub lever_m: Vector3<f64>,
    /// Mounting `R_ts`: turns the sensor's axes into those of the tip.
    pub tip_from_sensor: UnitQuaternion<f64>,
}

/// Derivatives of the reading `(f, w)` of a sensor on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MountSensitivity {
    /// With respect to the motion of the body.
    pub gain: SensorGain,
    /// With respect to the lever arm, 1/s² and 1/(m·s).
    pub lever: Matrix6x3<f64>,
    /// With respect to the mounting: `R_ts exp(δ)`.
    pub mounting: Matrix6x3<f64>,
}

impl SensorMount {
    /// At the tip's origin, along its axes.
    #[must_use]
    pub fn identity() -> Self {
        Self { lever_m: Vector3::zeros(), tip_from_sensor: UnitQuaternion::identity() }
    }

    /// What the sensor feels where the tip moves so.
    ///
    /// # Examples
    /// A body turns at 3 rad/s about z. A sensor 0.1 m along x feels 0.9 m/s² towards the axis.
    /// ```
    /// use calibrant_machine::chain::{FrameMotion, SensorMount};
    /// use nalgebra::Vector3;
    /// let body = FrameMotion { rate: Vector3::z() * 3.0, ..FrameMotion::at_rest(&Vector3::zeros()) };
    /// let mount = SensorMount { lever_m: Vector3::x() * 0.1, ..SensorMount::identity() };
    /// assert!((mount.motion(&body).specific_force - Vector3::x() * -0.9).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn motion(&self, tip: &FrameMotion) -> FrameMotion {
        tip.shifted(&self.lever_m).turned(&self.tip_from_sensor.to_rotation_matrix().into_inner())
    }

    /// What the sensor feels, and the derivatives of it.
    #[must_use]
    pub fn sensitivity(&self, tip: &FrameMotion) -> (FrameMotion, MountSensitivity) {
        let c = self.tip_from_sensor.to_rotation_matrix().into_inner();
        let sensor = tip.shifted(&self.lever_m).turned(&c);
        let start = SensorGain::identity();
        let [of_force, of_rate] = start.of_turn(&sensor);
        let mut mounting = Matrix6x3::zeros();
        mounting.fixed_rows_mut::<3>(0).copy_from(&of_force);
        mounting.fixed_rows_mut::<3>(3).copy_from(&of_rate);
        let mut lever = Matrix6x3::zeros();
        lever.fixed_rows_mut::<3>(0).copy_from(&c.tr_mul(&tip.force_gradient()));
        let gain = start.before_turn(&c).before_shift(&self.lever_m, tip);
        (sensor, MountSensitivity { gain, lever, mounting })
    }
}
