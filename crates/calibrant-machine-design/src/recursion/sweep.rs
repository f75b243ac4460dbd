//! The recursion from the base to the sensor, and its reverse. All vectors are in the axes of the base.
//!
//! # Forward
//! The motion of a frame is `(a, ω, ω̇)` with `a = p̈ − γ`. A vector `d` that is fixed in a frame has the derivatives `ḋ = ω×d`, `d̈ = ω̇×d + ω×ḋ`, `d⃛ = ω̈×d + 2ω̇×ḋ + ω×d̈`.
//! So has the axis `z` of a joint. A fixed step adds `d̈` to `a`; a joint that turns adds `z q̇` to `ω` and its derivative `ż q̇ + z q̈` to `ω̇`; one that slides adds the second derivative
//! of `z q` to `a`.
//!
//! # Derivatives by a joint
//! A joint at `o` moves the sensor at `p` by `h = z×r`, `r = p − o`, or by `h = z` where it slides. The specific force `a` of the sensor changes with the derivatives of `h` in time,
//!
//! ```text
//! ∂a/∂q = ḧ      ∂a/∂q̇ = 2ḣ      ∂a/∂q̈ = h            ḣ = ż×r + z×ṙ      ḧ = z̈×r + 2ż×ṙ + z×r̈
//! ```
//!
//! and a joint that turns turns the sensor's axes too, so that what it reads changes by `ḧ + a×z`. The rate that it reads changes by `∂ω/∂q = ż`, `∂ω/∂q̇ = z`.
//! `ṙ` and `r̈` are differences of velocities and of accelerations.
//!
//! # Reverse
//! A bar is the derivative of a scalar with respect to a motion. From the bars behind a step follow those before it, as the transpose of the step's
//! derivative. A joint that turns:
//!
//! ```text
//! q̈‾ = z·ω̇‾       q̇‾ = z·ω‾ + ż·ω̇‾       ω‾ += q̇ z×ω̇‾       q‾ = Σ (x×z)·x‾ over a, ω, ω̇
//! ```
//!
//! a shift by `d` (a fixed step, or `d = z q` of a joint that slides)
//!
//! ```text
//! ω̇‾ += d×a‾       ω‾ += a‾ (ω·d) + d (ω·a‾) − 2 ω (d·a‾)
//! ```
//!
//! and, for the joint that slides, `q̈‾ = z·a‾`, `q̇‾ = 2ż·a‾`, `q‾ = z̈·a‾`, `ω‾ += 2 q̇ z×a‾`.
//!
//! The reverse sweep costs about as much as the forward one, and gives the derivatives by all joints at once (`griewank2008`).

use super::links::{JointAxis, Links};
use super::vector::{M, V};

/// Specific force, angular rate and angular acceleration of a frame, or bars of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moving {
    pub(crate) a: V,
    pub(crate) w: V,
    pub(crate) wd: V,
}

impl Moving {
    pub(crate) const ZERO: Self = Self { a: V::ZERO, w: V::ZERO, wd: V::ZERO };

    /// The bars before a shift, from those behind it (`self`), with the rate there.
    #[inline(always)]
    fn shifted_back(&mut self, d: &V, w: &V) {
        let a = self.a;
        self.w += a * w.dot(d) + *d * w.dot(&a) - *w * (2.0 * d.dot(&a));
        self.wd += d.cross(&a);
    }
}

/// A joint at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JointAt {
    pub(crate) q: f64,
    pub(crate) qd: f64,
    pub(crate) qdd: f64,
    /// Of a joint that turns.
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl JointAt {
    pub(crate) const REST: Self = Self { q: 0.0, qd: 0.0, qdd: 0.0, cos: 1.0, sin: 0.0 };

    pub(crate) fn new(q: f64, qd: f64, qdd: f64) -> Self {
        let (sin, cos) = q.sin_cos();
        Self { q, qd, qdd, cos, sin }
    }
}

/// A frame behind a fixed step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    /// From its axes to those of the base.
    pub(crate) turn: M,
    pub(crate) origin: V,
    pub(crate) velocity: V,
    pub(crate) moving: Moving,
    /// The axis of the joint behind it, with derivatives in time.
    pub(crate) z: [V; 3],
    /// Derivatives in time of `a` and `ω̇`; only where they are asked for.
    pub(crate) third: [V; 2],
}

const AT_REST: Frame = Frame {
    turn: M::IDENTITY,
    origin: V::ZERO,
    velocity: V::ZERO,
    moving: Moving::ZERO,
    z: [V::ZERO; 3],
    third: [V::ZERO; 2],
};

/// How a reading, in the axes of the base, changes with a direction: specific force by position, speed and acceleration, then rate by position and speed.
pub(crate) type ReadingSlopes = [V; 5];

/// Derivatives of a scalar with respect to positions, velocities and accelerations of the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JointBars {
    pub(crate) q: f64,
    pub(crate) qd: f64,
    pub(crate) qdd: f64,
}

impl JointBars {
    pub(crate) const ZERO: Self = Self { q: 0.0, qd: 0.0, qdd: 0.0 };
}

/// The frames behind the fixed steps; the last is the sensor.
#[derive(Debug, Clone)]
pub(crate) struct Sweep {
    pub(crate) frames: Vec<Frame>,
}

/// `ḋ`, `d̈` of a vector that a frame carries.
#[inline(always)]
pub(crate) fn carried(d: &V, Moving { w, wd, .. }: &Moving) -> [V; 2] {
    let once = w.cross(d);
    [once, wd.cross(d) + w.cross(&once)]
}

impl Sweep {
    /// For a chain of this many joints.
    pub(crate) fn new(joints: usize) -> Self {
        Self { frames: vec![AT_REST; joints + 1] }
    }

    #[inline(always)]
    pub(crate) fn sensor(&self) -> &Frame {
        &self.frames[self.frames.len() - 1]
    }

    /// Specific force and rate in the axes of the sensor.
    pub(crate) fn readings(&self) -> [V; 2] {
        let sensor = self.sensor();
        [sensor.turn.transposed_times(&sensor.moving.a), sensor.turn.transposed_times(&sensor.moving.w)]
    }

    /// From the base to the sensor.
    pub(crate) fn forward(&mut self, links: &Links, joints: &[JointAt]) {
        let mut moving = Moving { a: links.base, ..Moving::ZERO };
        let (mut turn, mut origin, mut velocity) = (M::IDENTITY, V::ZERO, V::ZERO);
        for (k, (frame, fixed)) in self.frames.iter_mut().zip(&links.fixed).enumerate() {
            let d = turn.times(&fixed.rho);
            let [once, twice] = carried(&d, &moving);
            origin += d;
            velocity += once;
            moving.a += twice;
            turn = turn.product(&fixed.c);
            (frame.turn, frame.origin, frame.velocity, frame.moving) = (turn, origin, velocity, moving);
            let (Some(JointAxis { u, turns }), Some(joint)) = (links.joints.get(k), joints.get(k)) else {
                break;
            };
            let z = turn.times(u);
            let [zd, zdd] = carried(&z, &moving);
            frame.z = [z, zd, zdd];
            if *turns {
                moving.wd += zd * joint.qd + z * joint.qdd;
                moving.w += z * joint.qd;
                turn = turn.product(&turned(u, joint.cos, joint.sin));
            } else {
                origin += z * joint.q;
                velocity += zd * joint.q + z * joint.qd;
                moving.a += zdd * joint.q + zd * (2.0 * joint.qd) + z * joint.qdd;
            }
        }
    }

    /// The third derivatives, after [`Self::forward`].
    pub(crate) fn thirds(&mut self, links: &Links, joints: &[JointAt], jerks: &[f64]) {
        let [mut ad, mut wdd] = [V::ZERO; 2];
        for k in 0..joints.len() {
            let (behind, frame) = (self.frames[k + 1], &mut self.frames[k]);
            frame.third = [ad, wdd];
            let JointAt { q, qd, qdd, .. } = joints[k];
            let [z, zd, zdd] = frame.z;
            let mut d = behind.origin - frame.origin;
            if links.joints[k].turns {
                wdd += zdd * qd + zd * (2.0 * qdd) + z * jerks[k];
            } else {
                let Moving { w, wd, .. } = &frame.moving;
                let zddd = wdd.cross(&z) + wd.cross(&zd) * 2.0 + w.cross(&zdd);
                ad += zddd * q + zdd * (3.0 * qd) + zd * (3.0 * qdd) + z * jerks[k];
                d = d - z * q;
            }
            let [once, twice] = carried(&d, &behind.moving);
            let Moving { w, wd, .. } = &behind.moving;
            ad += wdd.cross(&d) + wd.cross(&once) * 2.0 + w.cross(&twice);
        }
        let last = self.frames.len() - 1;
        self.frames[last].third = [ad, wdd];
    }

    /// From a point that frame `k` carries at its origin to the sensor: `r`, `ṙ`, `r̈`.
    #[inline(always)]
    pub(crate) fn to_sensor(&self, k: usize) -> [V; 3] {
        let (frame, sensor) = (&self.frames[k], self.sensor());
        [sensor.origin - frame.origin, sensor.velocity - frame.velocity, sensor.moving.a - frame.moving.a]
    }

    /// The derivatives of the readings by a turn about `z` of what is behind frame `k`, where frame `k` carries the axis `z` with these derivatives.
    #[inline(always)]
    pub(crate) fn of_turn(&self, k: usize, [z, zd, zdd]: &[V; 3]) -> ReadingSlopes {
        let [r, rd, rdd] = self.to_sensor(k);
        let twice = zdd.cross(&r) + zd.cross(&rd) * 2.0 + z.cross(&rdd);
        [twice + self.sensor().moving.a.cross(z), (zd.cross(&r) + z.cross(&rd)) * 2.0, z.cross(&r), *zd, *z]
    }

    /// The derivatives of the readings by joint `k`.
    #[inline(always)]
    pub(crate) fn of_joint(&self, links: &Links, k: usize) -> ReadingSlopes {
        let z = &self.frames[k].z;
        if links.joints[k].turns { self.of_turn(k, z) } else { [z[2], z[1] * 2.0, z[0], V::ZERO, V::ZERO] }
    }

    /// From the sensor to the base: bars of the readings become those of the joints, which they are added to. `own` has bars of frame `k` beside them.
    #[inline(always)]
    pub(crate) fn reverse(
        &self,
        links: &Links,
        joints: &[JointAt],
        readings: &[V; 2],
        own: impl Fn(usize) -> Moving,
        bars: &mut [JointBars],
    ) {
        let turn = &self.sensor().turn;
        let (a, w) = (turn.times(&readings[0]), turn.times(&readings[1]));
        let mut bar = Moving { a, w, wd: V::ZERO };
        for k in (0..joints.len()).rev() {
            let own = own(k + 1);
            bar = Moving { a: bar.a + own.a, w: bar.w + own.w, wd: bar.wd + own.wd };
            let (frame, behind, joint) = (&self.frames[k], &self.frames[k + 1], &joints[k]);
            let [z, zd, zdd] = &frame.z;
            let Moving { a, w, wd } = &frame.moving;
            let d = behind.origin - frame.origin;
            let bars = &mut bars[k];
            if links.joints[k].turns {
                bar.shifted_back(&d, &behind.moving.w);
                bars.qdd += z.dot(&bar.wd);
                bars.qd += z.dot(&bar.w) + zd.dot(&bar.wd);
                bar.w += z.cross(&bar.wd) * joint.qd;
                bars.q += a.cross(z).dot(&bar.a) + w.cross(z).dot(&bar.w) + wd.cross(z).dot(&bar.wd);
            } else {
                bars.qdd += z.dot(&bar.a);
                bars.qd += 2.0 * zd.dot(&bar.a);
                bars.q += zdd.dot(&bar.a);
                let slid = z.cross(&bar.a) * (2.0 * joint.qd);
                // the fixed step and the joint shift by d together
                bar.shifted_back(&d, w);
                bar.w += slid;
            }
        }
    }
}

/// `exp(u q)`.
#[inline(always)]
fn turned(u: &V, cos: f64, sin: f64) -> M {
    let V([x, y, z]) = *u;
    let less = 1.0 - cos;
    let (a, b, c) = (x * less, y * less, z * less);
    M([
        V([a * x + cos, a * y - sin * z, a * z + sin * y]),
        V([b * x + sin * z, b * y + cos, b * z - sin * x]),
        V([c * x - sin * y, c * y + sin * x, c * z + cos]),
    ])
}
