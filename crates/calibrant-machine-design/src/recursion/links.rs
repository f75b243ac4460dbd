//! The chain as the recursion takes it: a fixed step before each joint, the joint, and a last fixed step to the sensor.

use super::vector::{M, V};
use calibrant_machine::chain::{KinematicChain, SensorMount};
use nalgebra::{Isometry3, Vector3};

/// A fixed step: translation `ρ`, and rotation `C` that gives the frame before from the frame behind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FixedStep {
    pub(crate) rho: V,
    pub(crate) c: M,
}

/// The axis of a joint, and whether it turns about it or slides along it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointAxis {
    pub(crate) u: V,
    pub(crate) turns: bool,
}

/// A chain with the sensor on it.
#[derive(Debug, Clone)]
pub(crate) struct Links {
    /// One for each joint, then that to the sensor.
    pub(crate) fixed: Vec<FixedStep>,
    pub(crate) joints: Vec<JointAxis>,
    /// Specific force `−γ` of the base, in its axes, m/s².
    pub(crate) base: V,
}

impl Links {
    /// The nominal chain. `gravity` is `γ` in the base.
    pub(crate) fn new(chain: &KinematicChain, mount: &SensorMount, gravity: &Vector3<f64>) -> Self {
        let tip = chain.tip_transform * Isometry3::from_parts(mount.lever_m.into(), mount.tip_from_sensor);
        let poses = chain.joints.iter().map(|joint| joint.origin).chain([tip]);
        let step = |pose: Isometry3<f64>| FixedStep {
            rho: V::of(&pose.translation.vector),
            c: M::of(&pose.rotation.to_rotation_matrix().into_inner()),
        };
        let axis = |joint: &calibrant_machine::chain::Joint| JointAxis {
            u: V::of(&joint.axis.into_inner()),
            turns: joint.kind.turns(),
        };
        Self {
            fixed: poses.map(step).collect(),
            joints: chain.joints.iter().map(axis).collect(),
            base: V::of(&-gravity),
        }
    }

    /// Specific force on the sensor at rest in a posture, in the sensor's axes.
    pub(crate) fn felt_at_rest(&self, posture: &[f64]) -> V {
        let mut felt = self.base;
        for (k, fixed) in self.fixed.iter().enumerate() {
            felt = fixed.c.transposed_times(&felt);
            if let (Some(JointAxis { u, turns: true }), Some(q)) = (self.joints.get(k), posture.get(k)) {
                let (sin, cos) = q.sin_cos();
                felt = felt * cos - u.cross(&felt) * sin + *u * (u.dot(&felt) * (1.0 - cos));
            }
        }
        felt
    }

    /// Number of joints.
    pub(crate) fn len(&self) -> usize {
        self.joints.len()
    }
}
