//! A body whose pose was logged: a spline of its position and one of its orientation.

use super::felt::set;
use super::{Felt, MotionColumns};
use crate::chain::{FrameMotion, SensorMount};
use crate::spline::{RotationSpline, VectorSpline, Weights, rotation_sensitivity, skew};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

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

    /// The motion of the body. `gravity` is `γ` in the world.
    pub(super) fn body(&self, weights: &Weights, gravity: &Vector3<f64>) -> FrameMotion {
        let at = self.orientation.with(weights);
        let specific_force =
            at.world_from_body.inverse_transform_vector(&(self.vector(weights, 2) - gravity));
        FrameMotion { specific_force, rate: at.rate, angular_acceleration: at.acceleration }
    }

    /// What a sensor feels. `gravity` is `γ` in the world.
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
        let body = FrameMotion { specific_force, rate: at.rate, angular_acceleration: at.acceleration };
        let (sensor, of_mount) = mount.sensitivity(&body);
        felt.force = sensor.specific_force;
        felt.rate = sensor.rate;
        let gain = of_mount.gain;
        let force_change = specific_force.cross(&at.rate) + to_body * self.vector(weights, 3);
        felt.change = gain.reading(&force_change, &at.acceleration, &at.jerk);
        for k in 0..3 {
            felt.columns[columns.lever() + k] = of_mount.lever.column(k).into_owned();
            felt.columns[columns.mounting() + k] = of_mount.mounting.column(k).into_owned();
        }
        let (by_force, zero) = (gain.sensor_from_frame * to_body, Matrix3::zeros());
        set(&mut felt.columns[columns.gravity()..], &-by_force, &zero);
        let Some(sensitivity) = sensitivity else { return };
        let turned = skew(&specific_force);
        for r in 0..weights.order {
            let first = r * POSE_UNKNOWNS;
            set(&mut felt.columns[first..], &(by_force * weights.derivative[2][r]), &zero);
            let of = &sensitivity.controls[r];
            let force = gain.sensor_from_frame * (turned * of.turn)
                + gain.force_of_rate * of.rate
                + gain.force_of_angular_acceleration * of.acceleration;
            set(&mut felt.columns[first + 3..], &force, &(gain.sensor_from_frame * of.rate));
        }
    }

    /// Moves the control points by steps of six numbers each.
    pub(crate) fn step(&mut self, steps: &[f64]) {
        for (i, step) in steps.chunks_exact(POSE_UNKNOWNS).enumerate() {
            for (control, step) in self.position.controls[3 * i..3 * i + 3].iter_mut().zip(step) {
                *control += step;
            }
            let turn = Vector3::new(step[3], step[4], step[5]);
            self.orientation.controls[i] *= UnitQuaternion::from_scaled_axis(turn);
        }
    }
}
