//! The step over a joint.

use super::{FrameMotion, SensorGain};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3, Vector6};

/// Positions of the joints and their derivatives.
#[derive(Debug, Clone, Copy)]
pub struct JointState<'a> {
    /// Positions, rad or m.
    pub positions: &'a [f64],
    /// Velocities, rad/s or m/s.
    pub velocities: &'a [f64],
    /// Accelerations, rad/s² or m/s².
    pub accelerations: &'a [f64],
}

/// A joint at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum JointMotion {
    /// About `u`, with the frame before from the frame behind it: `C = exp(u q)`.
    Turn { c: Matrix3<f64>, u: Vector3<f64>, qd: f64, qdd: f64 },
    /// Along `u`.
    Slide { u: Vector3<f64>, q: f64, qd: f64, qdd: f64 },
}

impl JointMotion {
    pub(super) fn new(turns: bool, axis: &Unit<Vector3<f64>>, [q, qd, qdd]: [f64; 3]) -> Self {
        let u = axis.into_inner();
        if turns {
            Self::Turn { c: Rotation3::from_axis_angle(axis, q).into_inner(), u, qd, qdd }
        } else {
            Self::Slide { u, q, qd, qdd }
        }
    }

    /// The motion behind the joint.
    pub(super) fn pass(&self, before: &FrameMotion) -> FrameMotion {
        match self {
            Self::Turn { c, u, qd, qdd } => {
                let FrameMotion { specific_force, rate, angular_acceleration } = before.turned(c);
                let angular_acceleration = angular_acceleration + rate.cross(u) * *qd + u * *qdd;
                FrameMotion { specific_force, rate: rate + u * *qd, angular_acceleration }
            }
            Self::Slide { u, q, qd, qdd } => {
                let mut behind = before.shifted(&(u * *q));
                behind.specific_force += before.rate.cross(u) * (2.0 * qd) + u * *qdd;
                behind
            }
        }
    }

    /// The gain of the frame before the joint, from that of the frame behind it.
    pub(super) fn pass_back(&self, behind: &SensorGain, before: &FrameMotion) -> SensorGain {
        match self {
            Self::Turn { c, u, qd, .. } => {
                let of_joint = behind.force_of_angular_acceleration * u.cross_matrix() * *qd;
                SensorGain { force_of_rate: behind.force_of_rate - of_joint, ..*behind }.before_turn(c)
            }
            Self::Slide { u, q, qd, .. } => {
                let mut gain = behind.before_shift(&(u * *q), before);
                gain.force_of_rate -= behind.sensor_from_frame * u.cross_matrix() * (2.0 * qd);
                gain
            }
        }
    }

    /// Derivatives of the reading with respect to the position, velocity and acceleration of the joint, from the motion and the gain behind it.
    pub(super) fn derivatives(&self, gain: &SensorGain, behind: &FrameMotion) -> [Vector6<f64>; 3] {
        let (Self::Turn { u, .. } | Self::Slide { u, .. }) = self;
        let FrameMotion { specific_force: a, rate: w, angular_acceleration: wd } = behind;
        let (zero, w_u) = (Vector3::zeros(), w.cross(u));
        match self {
            // C exp(u δ): what comes before the joint turns, and the joint's own u q̇ and u q̈ are along the axis of the turn
            Self::Turn { .. } => [
                gain.reading(&a.cross(u), &w_u, &wd.cross(u)),
                gain.reading(&zero, u, &w_u),
                gain.reading(&zero, &zero, u),
            ],
            Self::Slide { .. } => [
                gain.reading(&(wd.cross(u) + w.cross(&w_u)), &zero, &zero),
                gain.reading(&(w_u * 2.0), &zero, &zero),
                gain.reading(u, &zero, &zero),
            ],
        }
    }
}
