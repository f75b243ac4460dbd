//! The reference, whatever was logged.

use super::pose_motion::POSE_UNKNOWNS;
use super::{Felt, MotionColumns, PoseMotion, SensorMount};
use crate::spline::{UniformKnots, Weights};
use nalgebra::{Vector3, Vector6};

/// The motion of the reference.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Poses of the body.
    Poses(PoseMotion),
}

/// What turns the motion of the reference into what the sensor feels.
#[derive(Debug, Clone, Copy)]
pub struct Carrier<'a> {
    /// Gravity `γ` in the base frame (the world of poses), m/s².
    pub gravity: &'a Vector3<f64>,
    /// The sensor on the tip.
    pub mount: &'a SensorMount,
    /// Zero offsets of the joints.
    pub zeros: &'a [f64],
    /// Corrections of the joints' transforms.
    pub geometry: &'a [Vector6<f64>],
}

impl Motion {
    /// The knots of its splines.
    #[must_use]
    pub fn knots(&self) -> UniformKnots {
        match self {
            Self::Poses(poses) => poses.position.knots,
        }
    }

    /// Unknowns of a control point.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Poses(_) => POSE_UNKNOWNS,
        }
    }

    /// Where derivatives stand, with or without those by the control points.
    #[must_use]
    pub fn columns(&self, with_controls: bool) -> MotionColumns {
        let controls = if with_controls { self.unknowns() * self.knots().degree.order() } else { 0 };
        match self {
            Self::Poses(_) => MotionColumns { controls, joints: 0 },
        }
    }

    /// What the sensor feels with these weights.
    pub fn feel(&self, weights: &Weights, carrier: &Carrier<'_>, columns: MotionColumns, felt: &mut Felt) {
        match self {
            Self::Poses(poses) => poses.feel(weights, carrier.gravity, carrier.mount, columns, felt),
        }
    }

    /// Moves the control points.
    pub fn step(&mut self, steps: &[f64]) {
        match self {
            Self::Poses(poses) => poses.step(steps),
        }
    }
}
