//! The recursion from the base to the sensor, and its reverse.
//!
//! # Forward
//! The motion of a frame in its own axes is `(a, ω, ω̇)` with `a = Rᵀ(p̈ − γ)`. `calibrant_machine::chain` has the formulas of each step.
//!
//! # Reverse
//! A bar is the derivative of a scalar with respect to a motion. From the bars behind a step follow those before it, as the transpose of the step's
//! derivative. A joint that turns about `u` by `C = exp(u q)`, with `x̃ = Cᵀx` what comes before it in the axes behind it:
//!
//! ```text
//! q̈‾ = u·ω̇‾       q̇‾ = u·ω‾ + (ω̃×u)·ω̇‾       ω‾ += q̇ u×ω̇‾       q‾ = Σ (x̃×u)·x‾ over a, ω, ω̇       then x‾ ← C x‾
//! ```
//!
//! a shift by `ρ` (a fixed step after its turn by `C`, `a‾ ← C a‾`, or `ρ = u q` of a joint that slides)
//!
//! ```text
//! ω̇‾ += ρ×a‾       ω‾ += a‾ (ω·ρ) + ρ (ω·a‾) − 2 ω (ρ·a‾)
//! ```
//!
//! and, for the joint that slides, `q̈‾ = u·a‾`, `q̇‾ = 2 (ω×u)·a‾`, `q‾ = (ω̇×u + ω×(ω×u))·a‾`, `ω‾ += 2 q̇ u×a‾`.
//!
//! The reverse sweep costs about as much as the forward one, and gives the derivatives by all joints at once (`griewank2008`).

use super::links::{FixedStep, JointAxis, Links};
use super::number::Number;
use super::vector::V;

/// The motion of a frame, or bars of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moving<T> {
    /// Specific force.
    pub(crate) a: V<T>,
    /// Angular rate.
    pub(crate) w: V<T>,
    /// Angular acceleration.
    pub(crate) wd: V<T>,
}

impl<T: Number> Moving<T> {
    pub(crate) fn zero() -> Self {
        Self { a: V::zero(), w: V::zero(), wd: V::zero() }
    }

    #[inline(always)]
    fn each(&self, f: impl Fn(&V<T>) -> V<T>) -> Self {
        Self { a: f(&self.a), w: f(&self.w), wd: f(&self.wd) }
    }

    #[inline(always)]
    fn shifted(&self, rho: &V<T>) -> Self {
        Self { a: self.a + self.wd.cross(rho) + self.w.cross(&self.w.cross(rho)), ..*self }
    }

    /// The bars before a shift, from those behind it (`self`).
    #[inline(always)]
    fn shifted_back(&self, rho: &V<T>, before: &Self) -> Self {
        let (w, y) = (&before.w, &self.a);
        Self {
            a: *y,
            w: self.w + *y * w.dot(rho) + *rho * w.dot(y) - *w * (T::of(2.0) * rho.dot(y)),
            wd: self.wd + rho.cross(y),
        }
    }
}

/// A joint at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointAt<T> {
    pub(crate) q: T,
    pub(crate) qd: T,
    pub(crate) qdd: T,
    /// Of a joint that turns.
    pub(crate) cos: T,
    pub(crate) sin: T,
}

impl JointAt<f64> {
    pub(crate) fn new(q: f64, qd: f64, qdd: f64) -> Self {
        let (sin, cos) = q.sin_cos();
        Self { q, qd, qdd, cos, sin }
    }
}

/// `exp(u q) x`, or with `−sin` its inverse.
#[inline(always)]
fn turned<T: Number>(u: &V<T>, cos: T, sin: T, x: &V<T>) -> V<T> {
    *x * cos + u.cross(x) * sin + *u * (u.dot(x) * (T::of(1.0) - cos))
}

/// Motions along the chain. Index `2k` is the frame before fixed step `k` (0: the base), `2k + 1` the frame behind it; the last is the sensor.
#[derive(Debug, Clone)]
pub(crate) struct Sweep<T> {
    pub(crate) motions: Vec<Moving<T>>,
}

/// Derivatives of a scalar with respect to positions, velocities and accelerations of the joints.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointBars<T> {
    pub(crate) q: T,
    pub(crate) qd: T,
    pub(crate) qdd: T,
}

impl<T: Number> Sweep<T> {
    /// For a chain of this many joints.
    pub(crate) fn new(joints: usize) -> Self {
        Self { motions: vec![Moving::zero(); 2 * joints + 2] }
    }

    /// What the sensor feels.
    pub(crate) fn sensor(&self) -> &Moving<T> {
        &self.motions[self.motions.len() - 1]
    }

    /// From the base to the sensor.
    pub(crate) fn forward(&mut self, links: &Links<T>, joints: &[JointAt<T>]) {
        self.motions[0] = Moving { a: links.base, ..Moving::zero() };
        for (k, fixed) in links.fixed.iter().enumerate() {
            let behind = behind_fixed(fixed, &self.motions[2 * k]);
            self.motions[2 * k + 1] = behind;
            if let (Some(axis), Some(at)) = (links.joints.get(k), joints.get(k)) {
                self.motions[2 * k + 2] = behind_joint(axis, at, &behind);
            }
        }
    }

    /// From the sensor to the base: bars of the sensor's motion become those of the joints.
    pub(crate) fn reverse(
        &self,
        links: &Links<T>,
        joints: &[JointAt<T>],
        sensor: Moving<T>,
        bars: &mut [JointBars<T>],
    ) {
        let n = links.len();
        let mut bar = sensor;
        for k in (0..=n).rev() {
            if k < n {
                let (before, behind) = (&self.motions[2 * k + 1], &self.motions[2 * k + 2]);
                (bars[k], bar) = back_over_joint(&links.joints[k], &joints[k], before, behind, &bar);
            }
            let FixedStep { rho, c } = &links.fixed[k];
            bar = bar.each(|x| c.times(x)).shifted_back(rho, &self.motions[2 * k]);
        }
    }
}

#[inline(always)]
fn behind_fixed<T: Number>(FixedStep { rho, c }: &FixedStep<T>, before: &Moving<T>) -> Moving<T> {
    before.shifted(rho).each(|x| c.transposed_times(x))
}

#[inline(always)]
fn behind_joint<T: Number>(axis: &JointAxis<T>, at: &JointAt<T>, before: &Moving<T>) -> Moving<T> {
    let u = &axis.u;
    if axis.turns {
        let Moving { a, w, wd } = before.each(|x| turned(u, at.cos, -at.sin, x));
        Moving { a, w: w + *u * at.qd, wd: wd + w.cross(u) * at.qd + *u * at.qdd }
    } else {
        let mut behind = before.shifted(&(*u * at.q));
        behind.a += before.w.cross(u) * (T::of(2.0) * at.qd) + *u * at.qdd;
        behind
    }
}

#[inline(always)]
fn back_over_joint<T: Number>(
    axis: &JointAxis<T>,
    at: &JointAt<T>,
    before: &Moving<T>,
    behind: &Moving<T>,
    bar: &Moving<T>,
) -> (JointBars<T>, Moving<T>) {
    let u = &axis.u;
    if axis.turns {
        // what comes before the joint, in the axes behind it; parts along u vanish in the products
        let w = behind.w - *u * at.qd;
        let w_u = w.cross(u);
        let wd_u = (behind.wd - w_u * at.qd).cross(u);
        let qdd = u.dot(&bar.wd);
        let qd = u.dot(&bar.w) + w_u.dot(&bar.wd);
        let mut bar = *bar;
        bar.w += u.cross(&bar.wd) * at.qd;
        let q = behind.a.cross(u).dot(&bar.a) + w_u.dot(&bar.w) + wd_u.dot(&bar.wd);
        (JointBars { q, qd, qdd }, bar.each(|x| turned(u, at.cos, at.sin, x)))
    } else {
        let (w, y, two) = (&before.w, &bar.a, T::of(2.0));
        let w_u = w.cross(u);
        let bars =
            JointBars { q: (before.wd.cross(u) + w.cross(&w_u)).dot(y), qd: two * w_u.dot(y), qdd: u.dot(y) };
        let mut back = bar.shifted_back(&(*u * at.q), before);
        back.w += u.cross(y) * (two * at.qd);
        (bars, back)
    }
}
