//! Poses along the chain, and how points of the links move with the joints. A sweep has the joints' axes and places.

use crate::recursion::{JointAt, Links, M, Sweep, V};
use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Vector3};

/// Poses of the base and of the frames behind each joint, in the base.
pub(crate) fn poses(sweep: &Sweep, links: &Links, joints: &[JointAt], out: &mut [IsometryMatrix3<f64>]) {
    for (k, out) in out.iter_mut().skip(1).enumerate() {
        let frame = &sweep.frames[k];
        let origin =
            if links.joints[k].turns { frame.origin } else { frame.origin + frame.z[0] * joints[k].q };
        // behind the joint is before the next fixed step
        let M([V(x), V(y), V(z)]) = sweep.frames[k + 1].turn.product_transposed(&links.fixed[k + 1].c);
        let turn = Matrix3::new(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]);
        out.translation.vector = Vector3::from(origin.0);
        out.rotation = Rotation3::from_matrix_unchecked(turn);
    }
}

/// Velocity of a point that a joint carries, for a unit speed of the joint.
#[inline(always)]
pub(crate) fn per_joint(sweep: &Sweep, links: &Links, k: usize, point: &V) -> V {
    let frame = &sweep.frames[k];
    if links.joints[k].turns { frame.z[0].cross(&(*point - frame.origin)) } else { frame.z[0] }
}

/// The velocity `v` of a point behind all joints and the angular rate `ω` there, with derivatives.
///
/// With `v_k = z_k×(p − o_k)` (or `z_k` of a joint that slides): `v = Σ v_k q̇_k`. A turn of joint `k` turns all behind it, and moves the point under the joints before it:
/// `∂v/∂q_k = z_k × Σ_{i ≥ k} v_i q̇_i + ω_k × v_k` with the rate `ω_k` of the joints before `k`; a joint that slides has the second part alone.
/// `∂ω/∂q_k = z_k × Σ_{i > k} ω_i`: it does not change `|ω|` for `k` the first.
pub(crate) struct PointVelocity {
    pub(crate) v: V,
    pub(crate) w: V,
}

impl PointVelocity {
    /// Of a point of the last frame, in the base.
    pub(crate) fn new(sweep: &Sweep, links: &Links, joints: &[JointAt], point: &V) -> Self {
        let mut v = V::ZERO;
        for (k, joint) in joints.iter().enumerate() {
            v += per_joint(sweep, links, k, point) * joint.qd;
        }
        Self { v, w: sweep.sensor().moving.w }
    }

    /// Derivatives of `v·a + ω·b` by position and speed of each joint.
    pub(crate) fn slopes(
        &self,
        (sweep, links, joints): (&Sweep, &Links, &[JointAt]),
        point: &V,
        [a, b]: [&V; 2],
        mut write: impl FnMut(usize, f64, f64),
    ) {
        let mut before_v = V::ZERO;
        for (k, joint) in joints.iter().enumerate() {
            let own = per_joint(sweep, links, k, point);
            let (frame, speed) = (&sweep.frames[k], joint.qd);
            let mut by_speed = own.dot(a);
            let mut by_position = frame.moving.w.cross(&own).dot(a);
            if links.joints[k].turns {
                let z = &frame.z[0];
                by_speed += z.dot(b);
                by_position += z.cross(&(self.v - before_v)).dot(a);
                by_position += z.cross(&(self.w - frame.moving.w - *z * speed)).dot(b);
            }
            before_v += own * speed;
            write(k, by_position, by_speed);
        }
    }
}
