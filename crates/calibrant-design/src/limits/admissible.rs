//! The exact check of a motion against the limits, at all times and not only at its nodes.
//!
//! Acceleration is linear between nodes, so its extremes are there. Velocity is quadratic: it may peak where
//! the acceleration passes zero. Displacement is cubic: it may peak where the velocity passes zero. Both
//! places are roots of polynomials of degree one and two, so the check is exact.

use calibrant_core::json_object;
use calibrant_core::motion::{AxisLimits, JerkControlledMotion, Limits, Rest};
use calibrant_core::sensor::Axis;

/// A limit may be exceeded by this much, relatively, before it counts as violated. The reason is that numbers
/// in files are rounded.
pub const ROUNDING: f64 = 1e-6;

/// Which limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LimitKind {
    /// Largest acceleration.
    Acceleration,
    /// Largest jerk.
    Jerk,
    /// Largest intercept of an interval's line at t = 0.
    Intercept,
    /// Largest velocity.
    Velocity,
    /// Largest displacement.
    Displacement,
    /// Velocity zero at the end.
    RestAtEnd,
    /// Prescribed acceleration at the start.
    StartAcceleration,
    /// Prescribed acceleration at the end.
    EndAcceleration,
}

impl LimitKind {
    /// All limits.
    pub const ALL: [Self; 8] = [
        Self::Acceleration,
        Self::Jerk,
        Self::Intercept,
        Self::Velocity,
        Self::Displacement,
        Self::RestAtEnd,
        Self::StartAcceleration,
        Self::EndAcceleration,
    ];

    /// Its key in `[limits]`.
    #[must_use]
    pub fn key(self) -> &'static str {
        let [key, _, _] = self.words();
        key
    }

    /// In words: `acceleration`, `rest at the end`.
    #[must_use]
    pub fn name(self) -> &'static str {
        let [_, name, _] = self.words();
        name
    }

    /// Unit of its values: `m/s²`.
    #[must_use]
    pub fn unit(self) -> &'static str {
        let [_, _, unit] = self.words();
        unit
    }

    /// Key, name and unit.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Acceleration => ["acceleration_mps2", "acceleration", "m/s²"],
            Self::Jerk => ["jerk_mps3", "jerk", "m/s³"],
            Self::Intercept => ["intercept_mps2", "intercept", "m/s²"],
            Self::Velocity => ["velocity_mps", "velocity", "m/s"],
            Self::Displacement => ["displacement_m", "displacement", "m"],
            Self::RestAtEnd => ["rest", "rest at the end", "m/s"],
            Self::StartAcceleration => ["start_acceleration_mps2", "acceleration at the start", "m/s²"],
            Self::EndAcceleration => ["end_acceleration_mps2", "acceleration at the end", "m/s²"],
        }
    }
}

/// How far a motion goes towards one limit of one axis, and beyond it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitUse {
    /// The axis.
    pub axis: Axis,
    /// The limit.
    pub kind: LimitKind,
    /// When the motion is worst, s.
    pub time_s: f64,
    /// The motion's value then, with its sign, in the limit's unit.
    pub value: f64,
    /// The limit: zero for rest, the prescribed value for a prescribed acceleration.
    pub limit: f64,
    /// How far beyond the limit, relative to it: 0 where it is kept. For rest it is relative to the largest
    /// velocity allowed (or else reached). For a prescribed acceleration it is relative to the largest
    /// acceleration allowed (or else reached).
    pub violation: f64,
}

json_object! {
    /// How far a motion goes towards one limit of one axis, and beyond it. Numbers are in `unit`.
    LimitUse as of {
        /// The axis, by its letter.
        axis: of.axis.letter(),
        /// Which limit it is.
        limit: of.kind.key(),
        /// Unit of both numbers.
        unit: of.kind.unit(),
        /// When the motion is worst.
        time_s: of.time_s,
        /// The motion's value where it is worst, with its sign.
        value: of.value,
        /// The limit: zero for rest, and what is prescribed for an acceleration.
        allowed: of.limit,
        /// How far beyond the limit, relative to it.
        violation: of.violation,
        /// More than numbers in files are rounded.
        violated: of.is_violated(),
    }
}

impl LimitUse {
    /// Does the motion break it by more than [`ROUNDING`]?
    #[must_use]
    pub fn is_violated(&self) -> bool {
        self.violation > ROUNDING
    }

    /// How far beyond the limit, in its unit; 0 where it is kept.
    #[must_use]
    pub fn excess(&self) -> f64 {
        match self.kind {
            LimitKind::RestAtEnd | LimitKind::StartAcceleration | LimitKind::EndAcceleration => {
                (self.value - self.limit).abs()
            }
            _ => (self.value.abs() - self.limit).max(0.0),
        }
    }
}

/// How far a motion goes towards each given limit, axis by axis, at its worst time.
///
/// # Examples
/// ```
/// use calibrant_design::limit_use;
/// use calibrant_core::motion::{JerkControlledMotion, Limits};
/// use nalgebra::Vector3;
/// // a falls from 2 to −2 in 2 s: the velocity is zero at both nodes and 1 m/s in the middle
/// let motion = JerkControlledMotion::uniform(2.0, vec![Vector3::repeat(2.0), Vector3::repeat(-2.0)])?;
/// let limits = Limits { velocity_mps: Some(Vector3::repeat(0.8)), ..Limits::default() };
/// let velocity = &limit_use(&limits, 1, &motion)[0];
/// assert_eq!((velocity.time_s, velocity.value), (1.0, 1.0));
/// assert!(velocity.is_violated() && (velocity.violation - 0.25).abs() < 1e-15);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn limit_use(limits: &Limits, axes: usize, motion: &JerkControlledMotion) -> Vec<LimitUse> {
    Axis::ALL[..axes.min(3)]
        .iter()
        .flat_map(|&axis| {
            let a: Vec<f64> = motion.acceleration_mps2().iter().map(|a| a[axis.index()]).collect();
            axis_use(&limits.axis(axis.index()), motion.times_s(), &a)
                .into_iter()
                .map(move |found| LimitUse { axis, ..found })
        })
        .collect()
}

/// The worst relative violation of one axis' limits by node accelerations `a`; 0 where the motion keeps them
/// all.
pub(crate) fn worst_violation(limits: &AxisLimits, times: &[f64], a: &[f64]) -> f64 {
    axis_use(limits, times, a).into_iter().fold(0.0, |worst, found| found.violation.max(worst))
}

/// The largest magnitude of a quantity: (time, value).
#[derive(Clone, Copy)]
struct Peak(f64, f64);

impl Peak {
    fn see(&mut self, time: f64, value: f64) {
        if value.abs() > self.1.abs() {
            *self = Self(time, value);
        }
    }
}

fn axis_use(limits: &AxisLimits, times: &[f64], a: &[f64]) -> Vec<LimitUse> {
    let last = a.len() - 1;
    let none = Peak(times[0], 0.0);
    let (mut acceleration, mut jerk, mut intercept, mut velocity, mut displacement) =
        (none, none, none, none, none);
    acceleration.see(times[0], a[0]);
    let (mut v, mut d) = (0.0, 0.0);
    for i in 0..last {
        let (start, dt) = (times[i], times[i + 1] - times[i]);
        let u = (a[i + 1] - a[i]) / dt;
        acceleration.see(times[i + 1], a[i + 1]);
        jerk.see(start, u);
        intercept.see(start, a[i] - u * start);
        let v_at = |s: f64| v + s * (a[i] + s * u / 2.0);
        let d_at = |s: f64| d + s * (v + s * (a[i] / 2.0 + s * u / 6.0));
        let turn = -a[i] / u;
        if turn > 0.0 && turn < dt {
            velocity.see(start + turn, v_at(turn));
        }
        for rest in roots(u / 2.0, a[i], v) {
            if rest > 0.0 && rest < dt {
                displacement.see(start + rest, d_at(rest));
            }
        }
        d += dt * v + dt * dt * (2.0 * a[i] + a[i + 1]) / 6.0;
        v += dt * (a[i] + a[i + 1]) / 2.0;
        velocity.see(times[i + 1], v);
        displacement.see(times[i + 1], d);
    }
    let bounded = [
        (LimitKind::Acceleration, limits.acceleration, acceleration),
        (LimitKind::Jerk, limits.jerk, jerk),
        (LimitKind::Intercept, limits.intercept, intercept),
        (LimitKind::Velocity, limits.velocity, velocity),
        (LimitKind::Displacement, limits.displacement, displacement),
    ];
    let mut found: Vec<LimitUse> = bounded
        .into_iter()
        .filter_map(|(kind, limit, Peak(time_s, value))| {
            let limit = limit?;
            Some(LimitUse {
                axis: Axis::X,
                kind,
                time_s,
                value,
                limit,
                violation: (value.abs() / limit - 1.0).max(0.0),
            })
        })
        .collect();
    let mut held = |kind, time_s, value: f64, limit: f64, scale: f64| {
        let off = (value - limit).abs();
        let violation = if off > 0.0 { off / scale } else { 0.0 };
        found.push(LimitUse { axis: Axis::X, kind, time_s, value, limit, violation });
    };
    if limits.rest == Rest::Both {
        held(LimitKind::RestAtEnd, times[last], v, 0.0, limits.velocity.unwrap_or(velocity.1.abs()));
    }
    let scale = |target: f64| limits.acceleration.unwrap_or_else(|| acceleration.1.abs().max(target.abs()));
    if let Some(start) = limits.start {
        held(LimitKind::StartAcceleration, times[0], a[0], start, scale(start));
    }
    if let Some(end) = limits.end {
        held(LimitKind::EndAcceleration, times[last], a[last], end, scale(end));
    }
    found
}

/// Real roots of `a s² + b s + c`, without cancellation. A root at infinity is not among them.
fn roots(a: f64, b: f64, c: f64) -> impl Iterator<Item = f64> {
    let discriminant = b * b - 4.0 * a * c;
    let q = -0.5 * (b + discriminant.max(0.0).sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(move |root| discriminant >= 0.0 && root.is_finite())
}

#[cfg(test)]
#[path = "admissible_tests.rs"]
mod tests;
