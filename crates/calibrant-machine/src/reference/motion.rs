//! The reference, whatever was logged.

use super::pose_motion::POSE_UNKNOWNS;
use super::{Felt, JointMotion, MotionColumns, PoseMotion};
use crate::chain::{ChainCorrections, CorrectedChain, FrameMotion, SensorMount};
use crate::spline::{UniformKnots, Weights};
use nalgebra::Vector3;

/// The motion of the reference.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Positions of the joints of a chain.
    Joints(JointMotion),
    /// Poses of the body.
    Poses(PoseMotion),
}

/// What turns the motion of the reference into what the sensor feels.
#[derive(Debug, Clone)]
pub struct Carrier {
    /// Gravity `γ` in the base frame (the world of poses), m/s².
    pub gravity: Vector3<f64>,
    /// The sensor on the tip.
    pub mount: SensorMount,
    /// The chain with its corrections; none for poses.
    pub chain: Option<CorrectedChain>,
}

impl Motion {
    /// The knots of its splines.
    #[must_use]
    pub fn knots(&self) -> UniformKnots {
        match self {
            Self::Joints(joints) => joints.positions.knots,
            Self::Poses(poses) => poses.position.knots,
        }
    }

    /// Unknowns of a control point.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Joints(joints) => joints.positions.dimension,
            Self::Poses(_) => POSE_UNKNOWNS,
        }
    }

    /// Number of joints; none for poses.
    #[must_use]
    pub fn joints(&self) -> usize {
        match self {
            Self::Joints(joints) => joints.positions.dimension,
            Self::Poses(_) => 0,
        }
    }

    /// Where derivatives stand, with or without those by the control points.
    #[must_use]
    pub fn columns(&self, with_controls: bool) -> MotionColumns {
        let controls = if with_controls { self.unknowns() * self.knots().degree.order() } else { 0 };
        MotionColumns { controls, joints: self.joints() }
    }

    /// What carries the sensor, with these corrections of the chain.
    #[must_use]
    pub fn carrier(
        &self,
        gravity: Vector3<f64>,
        mount: SensorMount,
        corrections: &ChainCorrections,
    ) -> Carrier {
        let chain = match self {
            Self::Joints(joints) => Some(joints.chain.corrected(corrections)),
            Self::Poses(_) => None,
        };
        Carrier { gravity, mount, chain }
    }

    /// The motion of the sensor with these weights, without derivatives. `joints` is working memory, empty at first.
    #[must_use]
    pub fn sensor(&self, weights: &Weights, carrier: &Carrier, joints: &mut [Vec<f64>; 4]) -> FrameMotion {
        let tip = match (self, &carrier.chain) {
            (Self::Joints(motion), Some(chain)) => {
                chain.tip_motion(motion.state(weights, joints), &FrameMotion::at_rest(&carrier.gravity))
            }
            (Self::Poses(poses), _) => poses.body(weights, &carrier.gravity),
            (Self::Joints(_), None) => FrameMotion::at_rest(&carrier.gravity),
        };
        carrier.mount.motion(&tip)
    }

    /// What the sensor feels with these weights.
    pub fn feel(&self, weights: &Weights, carrier: &Carrier, columns: MotionColumns, felt: &mut Felt) {
        match (self, &carrier.chain) {
            (Self::Joints(joints), Some(chain)) => {
                joints.feel(weights, &carrier.gravity, chain, &carrier.mount, columns, felt);
            }
            (Self::Poses(poses), _) => poses.feel(weights, &carrier.gravity, &carrier.mount, columns, felt),
            (Self::Joints(_), None) => {}
        }
    }

    /// Moves the control points.
    pub fn step(&mut self, steps: &[f64]) {
        match self {
            Self::Joints(joints) => {
                for (control, step) in joints.positions.controls.iter_mut().zip(steps) {
                    *control += step;
                }
            }
            Self::Poses(poses) => poses.step(steps),
        }
    }
}
