//! Poses along the chain, and how points of the links move with the joints.

use calibrant_machine::chain::{Joint, KinematicChain};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// The chain at one posture.
#[derive(Debug, Clone)]
pub(crate) struct Posture {
    /// Poses of the base and of the frames behind each joint, in the base.
    pub(crate) frames: Vec<Isometry3<f64>>,
    /// Axis of each joint in the base.
    axes: Vec<Vector3<f64>>,
    turns: Vec<bool>,
}

impl Posture {
    pub(crate) fn new(chain: &KinematicChain) -> Self {
        let n = chain.joints.len();
        Self {
            frames: vec![Isometry3::identity(); n + 1],
            axes: vec![Vector3::z(); n],
            turns: chain.joints.iter().map(|joint| joint.kind.turns()).collect(),
        }
    }

    /// Takes these positions; `turns` are the cosine and sine of each.
    pub(crate) fn take(&mut self, joints: &[Joint], position: impl Fn(usize) -> f64) {
        for (k, joint) in joints.iter().enumerate() {
            let before = self.frames[k] * joint.origin;
            let q = position(k);
            self.axes[k] = before.rotation * joint.axis.into_inner();
            self.frames[k + 1] = if self.turns[k] {
                before * UnitQuaternion::from_axis_angle(&joint.axis, q)
            } else {
                before * Translation3::from(joint.axis.into_inner() * q)
            };
        }
    }

    /// Velocity of a point that a joint carries, for a unit speed of the joint.
    #[inline(always)]
    pub(crate) fn per_joint(&self, k: usize, point: &Vector3<f64>) -> Vector3<f64> {
        if self.turns[k] {
            self.axes[k].cross(&(point - self.frames[k + 1].translation.vector))
        } else {
            self.axes[k]
        }
    }

    /// Axis of a joint that turns, in the base.
    pub(crate) fn turn_axis(&self, k: usize) -> Option<&Vector3<f64>> {
        self.turns[k].then(|| &self.axes[k])
    }
}

/// The velocity `v` of a point behind all joints and the angular rate `ω` there, with derivatives.
///
/// With `v_k = z_k×(p − o_k)` (or `z_k` of a joint that slides): `v = Σ v_k q̇_k`. A turn of joint `k` turns all behind it, and moves the point under the joints before it:
/// `∂v/∂q_k = z_k × Σ_{i ≥ k} v_i q̇_i + ω_k × v_k` with the rate `ω_k` of the joints before `k`; a joint that slides has the second part alone.
/// `∂ω/∂q_k = z_k × Σ_{i > k} ω_i`: it does not change `|ω|` for `k` the first.
pub(crate) struct PointVelocity {
    pub(crate) v: Vector3<f64>,
    pub(crate) w: Vector3<f64>,
}

impl Posture {
    /// Velocity of a point of the last frame, in the base.
    pub(crate) fn point_velocity(&self, point: &Vector3<f64>, speed: impl Fn(usize) -> f64) -> PointVelocity {
        let mut of = PointVelocity { v: Vector3::zeros(), w: Vector3::zeros() };
        for k in 0..self.axes.len() {
            of.v += self.per_joint(k, point) * speed(k);
            if let Some(axis) = self.turn_axis(k) {
                of.w += axis * speed(k);
            }
        }
        of
    }

    /// Derivatives of `v·a + ω·b` by position and speed of each joint.
    pub(crate) fn velocity_slopes(
        &self,
        point: &Vector3<f64>,
        of: &PointVelocity,
        speed: impl Fn(usize) -> f64,
        [a, b]: [&Vector3<f64>; 2],
        mut write: impl FnMut(usize, f64, f64),
    ) {
        let (mut before_v, mut before_w) = (Vector3::zeros(), Vector3::zeros());
        for k in 0..self.axes.len() {
            let own = self.per_joint(k, point);
            let mut by_speed = own.dot(a);
            let mut by_position = before_w.cross(&own).dot(a);
            if let Some(axis) = self.turn_axis(k) {
                by_speed += axis.dot(b);
                by_position += axis.cross(&(of.v - before_v)).dot(a);
                before_w += axis * speed(k);
                by_position += axis.cross(&(of.w - before_w)).dot(b);
            }
            before_v += own * speed(k);
            write(k, by_position, by_speed);
        }
    }
}
