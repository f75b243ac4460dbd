//! The admissible motions of one axis, as rows of a convex program.
//!
//! All limits are linear in the nodes' accelerations, and sparse once velocity and displacement at the nodes
//! are variables too. Between the nodes the velocity is a quadratic and the displacement a cubic of the place
//! λ in the interval. Such a polynomial must keep a limit for all `λ ∈ [0, 1]`. That is a convex condition on
//! its Bernstein coefficients `β`, exactly:
//!
//! - quadratic `≥ 0`: there is `x ≤ β_1` with `[[β_0, x], [x, β_2]] ⪰ 0`;
//! - cubic `≥ 0`: it is `(1 − λ) A + λ B` with A, B sums of squares: `[[β_0, x], [x, y]] ⪰ 0`, `[[z, w], [w, β_3]] ⪰ 0`,
//!   `3 β_1 = 2x + z`, `3 β_2 = y + 2w`.
//!
//! These cones are added only for the intervals that need them ([`WatchedIntervals`]).
//!
//! # References
//! `nesterov2000`

use crate::convex::{ConicProgram, Row};
use calibrant_core::motion::{AxisLimits, Rest};

/// The motions of one axis that keep its limits.
#[derive(Debug, Clone)]
pub(crate) struct Region {
    pub(crate) limits: AxisLimits,
    /// Breakpoints, from 0.
    pub(crate) tau: Vec<f64>,
    /// Natural size of an acceleration, m/s².
    pub(crate) size: f64,
}

/// Intervals whose inside needs extra conditions.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct WatchedIntervals {
    velocity: Vec<bool>,
    displacement: Vec<bool>,
}

/// A quantity that may peak between the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    Velocity,
    Displacement,
}

/// A limit that a motion breaks between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InsideBreach {
    pub(crate) interval: usize,
    /// Time of the peak after the start of the interval, s.
    pub(crate) time: f64,
    pub(crate) state: State,
    pub(crate) limit: f64,
}

/// Relative breach of a limit inside an interval from which on it counts.
const BREACH: f64 = 1e-9;

impl Region {
    pub(crate) fn new(limits: AxisLimits, tau: &[f64]) -> Self {
        let dt = (tau[tau.len() - 1] - tau[0]) / (tau.len() - 1) as f64;
        let sizes = [
            limits.acceleration,
            limits.intercept,
            limits.jerk.map(|jerk| jerk * (tau[tau.len() - 1] - tau[0])),
            limits.velocity.map(|velocity| 4.0 * velocity / dt),
            limits.displacement.map(|displacement| 20.0 * displacement / (dt * dt)),
        ];
        let size = sizes.into_iter().flatten().fold(f64::INFINITY, f64::min);
        Self { limits, tau: tau.iter().map(|t| t - tau[0]).collect(), size }
    }

    /// Number of intervals.
    pub(crate) fn intervals(&self) -> usize {
        self.tau.len() - 1
    }

    /// Do limits on velocity or displacement count?
    pub(crate) fn has_states(&self) -> bool {
        self.limits.velocity.is_some() || self.limits.displacement.is_some() || self.limits.rest == Rest::Both
    }

    /// Adds the limits on the motion whose node i is `size · x[nodes(i)]`.
    pub(crate) fn add_to(
        &self,
        program: &mut ConicProgram,
        nodes: impl Fn(usize) -> usize,
        watch: &WatchedIntervals,
    ) {
        let l = &self.limits;
        let n = self.intervals();
        let a = |i: usize| Row::new(0.0, [(nodes(i), self.size)]);
        for i in 0..=n {
            if let Some(limit) = l.acceleration {
                program.within(&a(i), limit);
            }
        }
        for i in 0..n {
            let dt = self.tau[i + 1] - self.tau[i];
            let u = a(i + 1).plus(&a(i).times(-1.0)).times(1.0 / dt);
            if let Some(limit) = l.jerk {
                program.within(&u, limit);
            }
            if let Some(limit) = l.intercept {
                program.within(&a(i).plus(&u.times(-self.tau[i])), limit);
            }
        }
        for (node, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value {
                program.zero(Row::new(-value / self.size, [(nodes(node), 1.0)]));
            }
        }
        if self.has_states() {
            self.add_states(program, &a, watch);
        }
    }

    /// Velocity and displacement: variables at the nodes, limits at the nodes and, where watched, between them.
    fn add_states(&self, program: &mut ConicProgram, a: &dyn Fn(usize) -> Row, watch: &WatchedIntervals) {
        let l = &self.limits;
        let n = self.intervals();
        let dt = self.tau[1];
        let v_size = l.velocity.unwrap_or(self.size * dt);
        let d_size = l.displacement.unwrap_or(v_size * dt);
        let first_v = program.add_variables(n);
        let first_d = l.displacement.map(|_| program.add_variables(n));
        let v = |i: usize| if i == 0 { Row::default() } else { Row::new(0.0, [(first_v + i - 1, v_size)]) };
        for i in 0..n {
            let dt = self.tau[i + 1] - self.tau[i];
            let next = v(i).plus(&a(i).plus(&a(i + 1)).times(dt / 2.0));
            program.zero(next.plus(&v(i + 1).times(-1.0)).times(1.0 / v_size));
            if let Some(limit) = l.velocity {
                program.within(&v(i + 1), limit);
                if watch.velocity.get(i) == Some(&true) {
                    let middle = v(i).plus(&a(i).times(dt / 2.0));
                    keep_quadratic(program, &[v(i), middle, v(i + 1)], limit);
                }
            }
        }
        if l.rest == Rest::Both {
            program.zero(v(n).times(1.0 / v_size));
        }
        let (Some(limit), Some(first_d)) = (l.displacement, first_d) else { return };
        let d = |i: usize| if i == 0 { Row::default() } else { Row::new(0.0, [(first_d + i - 1, d_size)]) };
        for i in 0..n {
            let dt = self.tau[i + 1] - self.tau[i];
            let bend = a(i).times(2.0).plus(&a(i + 1)).times(dt * dt / 6.0);
            let next = d(i).plus(&v(i).times(dt)).plus(&bend);
            program.zero(next.plus(&d(i + 1).times(-1.0)).times(1.0 / d_size));
            program.within(&d(i + 1), limit);
            if watch.displacement.get(i) == Some(&true) {
                let early = d(i).plus(&v(i).times(dt / 3.0));
                let late = d(i + 1).plus(&v(i + 1).times(-dt / 3.0));
                keep_cubic(program, &[d(i), early, late, d(i + 1)], limit);
            }
        }
    }

    /// Watches the intervals in which the motion `a` breaks a limit between the nodes. Returns whether there
    /// was a new one.
    pub(crate) fn update_watch(&self, a: &[f64], watch: &mut WatchedIntervals) -> bool {
        let n = self.intervals();
        watch.velocity.resize(n, false);
        watch.displacement.resize(n, false);
        let mut news = false;
        for breach in self.broken_inside(a) {
            let watched = match breach.state {
                State::Velocity => &mut watch.velocity[breach.interval],
                State::Displacement => &mut watch.displacement[breach.interval],
            };
            news |= !std::mem::replace(watched, true);
        }
        news
    }

    /// The limits that the motion `a` breaks between the nodes, each where it is worst in an interval.
    pub(crate) fn broken_inside(&self, a: &[f64]) -> Vec<InsideBreach> {
        let l = &self.limits;
        let mut broken = Vec::new();
        let (mut v, mut d) = (0.0, 0.0);
        for interval in 0..self.intervals() {
            let at = self.inside(a, interval, v, d);
            for (state, limit, peak) in [
                (State::Velocity, l.velocity, at.peak_velocity()),
                (State::Displacement, l.displacement, at.peak_displacement()),
            ] {
                if let Some((limit, (value, time))) = limit.zip(peak)
                    && value > limit * (1.0 + BREACH)
                {
                    broken.push(InsideBreach { interval, time, state, limit });
                }
            }
            (v, d) = at.end();
        }
        broken
    }

    /// Largest relative breach of any limit, at any time; 0 where the motion is admissible. Equalities count against the natural size.
    pub(crate) fn breach(&self, a: &[f64]) -> f64 {
        let l = &self.limits;
        let n = self.intervals();
        let mut worst = 0.0_f64;
        let mut within = |value: f64, limit: Option<f64>| {
            if let Some(limit) = limit {
                worst = worst.max(value.abs() / limit - 1.0);
            }
        };
        let (mut v, mut d) = (0.0, 0.0);
        for i in 0..n {
            let at = self.inside(a, i, v, d);
            within(a[i], l.acceleration);
            within(at.u, l.jerk);
            within(a[i] - at.u * self.tau[i], l.intercept);
            (v, d) = at.end();
            within(at.peak_velocity().map_or(v, |(peak, _)| peak.max(v.abs())), l.velocity);
            within(at.peak_displacement().map_or(d, |(peak, _)| peak.max(d.abs())), l.displacement);
        }
        within(a[n], l.acceleration);
        if l.rest == Rest::Both {
            worst = worst.max(v.abs() / (self.size * self.tau[n]) - 1e-12);
        }
        worst
    }

    /// The motion inside interval i, from velocity v and displacement d.
    fn inside(&self, a: &[f64], i: usize, v: f64, d: f64) -> Polynomial {
        let dt = self.tau[i + 1] - self.tau[i];
        Polynomial { d, v, a: a[i], u: (a[i + 1] - a[i]) / dt, dt }
    }

    /// Restores the equalities to rounding: prescribed ends, and rest at the end by an equal change of all
    /// inner nodes.
    pub(crate) fn settle(&self, a: &mut [f64]) {
        let (n, l) = (self.intervals(), &self.limits);
        for (node, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value {
                a[node] = value;
            }
        }
        if l.rest == Rest::Both && n > 1 {
            let v: f64 = (0..n).map(|i| (a[i] + a[i + 1]) / 2.0 * (self.tau[i + 1] - self.tau[i])).sum();
            let inner: f64 = (1..n).map(|i| (self.tau[i + 1] - self.tau[i - 1]) / 2.0).sum();
            a[1..n].iter_mut().for_each(|a| *a -= v / inner);
        }
    }

    /// The admissible motion next to one that is admissible only to the accuracy of the convex solver. It
    /// restores the equalities exactly, then shrinks the motion towards `inside`. That is an admissible
    /// motion at a relative distance `slack` from every limit.
    pub(crate) fn restore(&self, a: &mut [f64], inside: &[f64], slack: f64) {
        for _ in 0..2 {
            self.settle(a);
            let breach = self.breach(a);
            if breach <= 0.0 {
                return;
            }
            let keep = slack / (slack + breach * (1.0 + 1e-6) + 1e-15);
            for (a, inside) in a.iter_mut().zip(inside) {
                *a = inside + (*a - inside) * keep;
            }
        }
    }
}

/// `|p| ≤ limit` on an interval, for the quadratic with these Bernstein coefficients.
fn keep_quadratic(program: &mut ConicProgram, beta: &[Row; 3], limit: f64) {
    for sign in [1.0, -1.0] {
        let left = |i: usize| Row::new(1.0, []).plus(&beta[i].clone().times(-sign / limit));
        let x = program.add_variables(1);
        program.nonnegative(left(1).plus(&Row::new(0.0, [(x, -1.0)])));
        program.semidefinite_2(left(0), Row::new(0.0, [(x, 1.0)]), left(2));
    }
}

/// `|p| ≤ limit` on an interval, for the cubic with these Bernstein coefficients.
fn keep_cubic(program: &mut ConicProgram, beta: &[Row; 4], limit: f64) {
    for sign in [1.0, -1.0] {
        let left = |i: usize| Row::new(1.0, []).plus(&beta[i].clone().times(-sign / limit));
        let x = program.add_variables(2);
        let var = |k: usize, factor: f64| Row::new(0.0, [(k, factor)]);
        let (x, w) = (x, x + 1);
        let z = left(1).times(3.0).plus(&var(x, -2.0));
        let y = left(2).times(3.0).plus(&var(w, -2.0));
        program.semidefinite_2(left(0), var(x, 1.0), y);
        program.semidefinite_2(z, var(w, 1.0), left(3));
    }
}

/// The motion inside one interval.
struct Polynomial {
    d: f64,
    v: f64,
    a: f64,
    u: f64,
    dt: f64,
}

impl Polynomial {
    fn velocity(&self, t: f64) -> f64 {
        self.v + t * (self.a + t * self.u / 2.0)
    }

    fn displacement(&self, t: f64) -> f64 {
        self.d + t * (self.v + t * (self.a / 2.0 + t * self.u / 6.0))
    }

    /// Velocity and displacement at its end.
    fn end(&self) -> (f64, f64) {
        (self.velocity(self.dt), self.displacement(self.dt))
    }

    /// The largest size of the velocity between the nodes, and its time after the start of the interval.
    /// `None` where it has no extreme there.
    fn peak_velocity(&self) -> Option<(f64, f64)> {
        let t = -self.a / self.u;
        (t > 0.0 && t < self.dt).then(|| (self.velocity(t).abs(), t))
    }

    /// The same for the displacement.
    fn peak_displacement(&self) -> Option<(f64, f64)> {
        // v + a t + u t²/2 = 0, in the form that does not cancel
        let root = (self.a * self.a - 2.0 * self.u * self.v).sqrt();
        let q = -(self.a + self.a.signum() * root);
        [q / self.u, 2.0 * self.v / q]
            .into_iter()
            .filter(|&t| t > 0.0 && t < self.dt)
            .map(|t| (self.displacement(t).abs(), t))
            .max_by(|one, other| one.0.total_cmp(&other.0))
    }
}
