//! The step from the body that the machine moves to the sensor on it.

use super::{Felt, MotionColumns};
use crate::spline::skew;
use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3, Vector6};

/// Where the sensor is on the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorMount {
    /// The sensor's place in the axes of the body, m.
    pub lever_m: Vector3<f64>,
    /// Rotation `R_ts`: from the sensor's frame to that of the body.
    pub tip_from_sensor: UnitQuaternion<f64>,
}

/// The motion of a body in its own axes: specific force `Rᵀ(p̈ − γ)`, rate and angular acceleration.
#[derive(Debug, Clone, Copy)]
pub struct BodyMotion {
    /// Specific force at the body's origin, m/s².
    pub specific_force: Vector3<f64>,
    /// Angular rate, rad/s.
    pub rate: Vector3<f64>,
    /// Angular acceleration, rad/s².
    pub angular_acceleration: Vector3<f64>,
}

/// Derivative of force and rate at the sensor with respect to the motion of the body: specific force, rate, angular acceleration.
pub type FromBody = SMatrix<f64, 6, 9>;

impl SensorMount {
    /// Writes what the sensor feels, its derivatives by lever arm and mounting, and returns those by the motion of the body.
    ///
    /// `f = R_tsᵀ (a + ω̇×r + ω×(ω×r))`, `w = R_tsᵀ ω`.
    pub(crate) fn feel(&self, body: &BodyMotion, columns: MotionColumns, felt: &mut Felt) -> FromBody {
        let to_sensor = self.tip_from_sensor.inverse().to_rotation_matrix().into_inner();
        let (omega, alpha, r) = (body.rate, body.angular_acceleration, self.lever_m);
        let (omega_x, alpha_x) = (skew(&omega), skew(&alpha));
        let swept = omega.cross(&r);
        felt.force = to_sensor * (body.specific_force + alpha.cross(&r) + omega.cross(&swept));
        felt.rate = to_sensor * omega;
        let by_lever = to_sensor * (alpha_x + omega_x * omega_x);
        let [turned_force, turned_rate] = [skew(&felt.force), skew(&felt.rate)];
        let zero = Matrix3::zeros();
        set(&mut felt.columns[columns.lever()..], &by_lever, &zero);
        set(&mut felt.columns[columns.mounting()..], &turned_force, &turned_rate);
        let mut from_body = FromBody::zeros();
        from_body.fixed_view_mut::<3, 3>(0, 0).copy_from(&to_sensor);
        from_body.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-to_sensor * (skew(&swept) + omega_x * skew(&r))));
        from_body.fixed_view_mut::<3, 3>(0, 6).copy_from(&(-to_sensor * skew(&r)));
        from_body.fixed_view_mut::<3, 3>(3, 3).copy_from(&to_sensor);
        from_body
    }
}

/// Sets three columns: the force's part and the rate's.
pub(super) fn set(columns: &mut [Vector6<f64>], force: &Matrix3<f64>, rate: &Matrix3<f64>) {
    for (axis, column) in columns.iter_mut().take(3).enumerate() {
        column.fixed_rows_mut::<3>(0).copy_from(&force.column(axis));
        column.fixed_rows_mut::<3>(3).copy_from(&rate.column(axis));
    }
}
