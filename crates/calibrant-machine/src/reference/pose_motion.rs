//! A body whose pose was logged: a spline of its position and one of its orientation.

use super::mount::{BodyMotion, SensorMount, set};
use super::{Felt, MotionColumns};
use crate::spline::{RotationSpline, VectorSpline, Weights, rotation_sensitivity, skew};
use nalgebra::{Matrix3, SVector, UnitQuaternion, Vector3};

/// Position and orientation of the body in the world, on the same knots.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseMotion {
    /// Position, m.
    pub position: VectorSpline,
    /// Orientation.
    pub orientation: RotationSpline,
}

/// Unknowns of a control point: position, then turn about the axes of the control point.
pub(crate) const POSE_UNKNOWNS: usize = 6;

impl PoseMotion {
    fn vector(&self, weights: &Weights, derivative: usize) -> Vector3<f64> {
        Vector3::from_fn(|j, _| self.position.component(weights, derivative, j))
    }

    /// What a sensor feels. `gravity` is `γ` in the world. With `controls` the derivatives by the control points, too.
    pub(crate) fn feel(
        &self,
        weights: &Weights,
        gravity: &Vector3<f64>,
        mount: &SensorMount,
        columns: MotionColumns,
        felt: &mut Felt,
    ) {
        let with_controls = columns.controls > 0;
        let sensitivity = with_controls.then(|| rotation_sensitivity(&self.orientation, weights));
        let at = sensitivity.as_ref().map_or_else(|| self.orientation.with(weights), |of| of.at);
        let to_body = at.world_from_body.inverse().to_rotation_matrix().into_inner();
        let specific_force = to_body * (self.vector(weights, 2) - gravity);
        let body = BodyMotion { specific_force, rate: at.rate, angular_acceleration: at.acceleration };
        let from_body = mount.feel(&body, columns, felt);
        let of_force = from_body.fixed_columns::<3>(0).into_owned();
        let force_change = specific_force.cross(&at.rate) + to_body * self.vector(weights, 3);
        let mut change = SVector::<f64, 9>::zeros();
        change.fixed_rows_mut::<3>(0).copy_from(&force_change);
        change.fixed_rows_mut::<3>(3).copy_from(&at.acceleration);
        change.fixed_rows_mut::<3>(6).copy_from(&at.jerk);
        felt.change = from_body * change;
        let by_gravity = of_force * -to_body;
        let halves = |by: &nalgebra::SMatrix<f64, 6, 3>| -> [Matrix3<f64>; 2] {
            [by.fixed_rows::<3>(0).into_owned(), by.fixed_rows::<3>(3).into_owned()]
        };
        let [force, rate] = halves(&by_gravity);
        set(&mut felt.columns[columns.gravity()..], &force, &rate);
        let Some(sensitivity) = sensitivity else { return };
        let of_rate = from_body.fixed_columns::<3>(3).into_owned();
        let of_acceleration = from_body.fixed_columns::<3>(6).into_owned();
        let turned = skew(&specific_force);
        for r in 0..weights.order {
            let first = r * POSE_UNKNOWNS;
            let [force, rate] = halves(&(of_force * to_body * weights.derivative[2][r]));
            set(&mut felt.columns[first..], &force, &rate);
            let of = &sensitivity.controls[r];
            let by_turn =
                of_force * (turned * of.turn) + of_rate * of.rate + of_acceleration * of.acceleration;
            let [force, rate] = halves(&by_turn);
            set(&mut felt.columns[first + 3..], &force, &rate);
        }
    }

    /// Position and orientation with these weights.
    pub(crate) fn pose(&self, weights: &Weights) -> (Vector3<f64>, UnitQuaternion<f64>) {
        (self.vector(weights, 0), self.orientation.with(weights).world_from_body)
    }

    /// Moves the control points by steps of six numbers each.
    pub(crate) fn step(&mut self, steps: &[f64]) {
        for (i, step) in steps.chunks_exact(POSE_UNKNOWNS).enumerate() {
            for j in 0..3 {
                self.position.controls[3 * i + j] += step[j];
            }
            let turn = Vector3::new(step[3], step[4], step[5]);
            self.orientation.controls[i] *= UnitQuaternion::from_scaled_axis(turn);
        }
    }
}
