//! A chain whose joints were logged: a spline of their positions.

use super::{Felt, MotionColumns};
use crate::chain::{CorrectedChain, FrameMotion, JointState, KinematicChain, SensorMount};
use crate::spline::{VectorSpline, Weights};
use nalgebra::{Vector3, Vector6};

/// The chain and the positions of its joints, as their encoders read them.
#[derive(Debug, Clone, PartialEq)]
pub struct JointMotion {
    /// The chain as its file says.
    pub chain: KinematicChain,
    /// Positions of the joints, rad or m.
    pub positions: VectorSpline,
}

impl JointMotion {
    /// The joints with these weights, in `joints`: position and three derivatives.
    pub(super) fn state<'j>(&self, weights: &Weights, joints: &'j mut [Vec<f64>; 4]) -> JointState<'j> {
        for (derivative, values) in joints.iter_mut().enumerate() {
            values.resize(self.positions.dimension, 0.0);
            self.positions.write(weights, derivative, values);
        }
        let [positions, velocities, accelerations, _] = joints;
        JointState { positions, velocities, accelerations }
    }

    /// What a sensor feels. `gravity` is `γ` in the base frame.
    pub(crate) fn feel(
        &self,
        weights: &Weights,
        gravity: &Vector3<f64>,
        chain: &CorrectedChain,
        mount: &SensorMount,
        columns: MotionColumns,
        felt: &mut Felt,
    ) {
        let n = columns.joints;
        let state = self.state(weights, &mut felt.joints);
        let of = &mut felt.chain;
        of.evaluate(chain, state, &FrameMotion::at_rest(gravity), mount);
        let [_, velocities, accelerations, jerks] = &felt.joints;
        felt.force = of.sensor.specific_force;
        felt.rate = of.sensor.rate;
        felt.change = Vector6::zeros();
        let columns_of = &mut felt.columns;
        for j in 0..n {
            let [by_position, by_velocity, by_acceleration]: [Vector6<f64>; 3] =
                [&of.positions, &of.velocities, &of.accelerations].map(|by| by.column(j).into_owned());
            felt.change +=
                by_position * velocities[j] + by_velocity * accelerations[j] + by_acceleration * jerks[j];
            if columns.controls > 0 {
                for r in 0..weights.order {
                    let [w0, w1, w2, _] = weights.derivative.map(|of| of[r]);
                    columns_of[r * n + j] = by_position * w0 + by_velocity * w1 + by_acceleration * w2;
                }
            }
            columns_of[columns.zeros() + j] = by_position;
        }
        for k in 0..6 * n {
            columns_of[columns.geometry() + k] = of.geometry.column(k).into_owned();
        }
        let by_gravity = of.gravity();
        for k in 0..3 {
            columns_of[columns.lever() + k] = of.mount.lever.column(k).into_owned();
            columns_of[columns.mounting() + k] = of.mount.mounting.column(k).into_owned();
            columns_of[columns.gravity() + k] = by_gravity.column(k).into_owned();
        }
    }
}
