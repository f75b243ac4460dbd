//! Closed-form bounds that no admissible motion can exceed. They scale every unknown of the relaxation, and
//! are a bound of their own.
//!
//! Bound tightening: smaller bounds on nodes and states, by linear programs.
//!
//! Closed forms do not cover limits of many nodes that act together. Examples are how fast the velocity limit
//! lets the acceleration swing, and how far the displacement limit lets it go. The bounds scale every unknown
//! of the relaxation, and a tight scale is half of a tight relaxation.

use super::dual_bound::{MomentProgram, Patience};
use crate::Interruption;
use crate::convex::Row;
use calibrant_core::motion::{AxisLimits, IntervalSums, Rest};
use rayon::prelude::*;

/// Bounds on the sizes of node accelerations and of the chain's states at the nodes; infinite where there is none.
#[derive(Debug, Clone)]
pub(super) struct StateBounds {
    /// Acceleration, m/s².
    pub(super) a: Vec<f64>,
    /// Velocity, m/s.
    pub(super) v: Vec<f64>,
    /// Displacement, m.
    pub(super) d: Vec<f64>,
    /// Sum of the samples before the node, m/s².
    pub(super) sum: Vec<f64>,
}

impl StateBounds {
    /// Propagates the limits along the chain and back.
    ///
    /// Limits that hold for all t bound derivatives inside an interval too, by Markov's inequality. For
    /// polynomials of degree n on an interval of length Δτ, `|p'| ≤ 2n² max|p|/Δτ` and
    /// `|p''| ≤ 4n²(n² − 1) max|p|/(3 Δτ²)`. So `|α| ≤ 8 v_max/Δτ`, `|α| ≤ 96 d_max/Δτ²`,
    /// `|v| ≤ 18 d_max/Δτ`.
    pub(super) fn of(chain: &AxisChain) -> Self {
        let (n, dt, l) = (chain.sums.len(), chain.interval_s, &chain.limits);
        let unlimited = f64::INFINITY;
        let acceleration = l.acceleration.unwrap_or(unlimited);
        let velocity = l.velocity.unwrap_or(unlimited);
        let displacement = l.displacement.unwrap_or(unlimited);
        let step = l.jerk.unwrap_or(unlimited) * dt;
        let markov = (8.0 * velocity / dt).min(96.0 * displacement / (dt * dt));
        let mut a = vec![acceleration.min(markov); n + 1];
        if let (Some(x), Some(u)) = (l.intercept, l.jerk) {
            // a node is on the lines of both its intervals
            a.iter_mut().enumerate().for_each(|(i, a)| *a = a.min(x + u * i as f64 * dt));
        }
        if let Some(x) = l.intercept {
            a[0] = a[0].min(x);
        }
        for (node, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value {
                a[node] = a[node].min(value.abs());
            }
        }
        for i in 0..n {
            a[i + 1] = a[i + 1].min(a[i] + step);
        }
        for i in (0..n).rev() {
            a[i] = a[i].min(a[i + 1] + step);
        }

        let (mut v, mut d, mut sum) = (vec![0.0; n + 1], vec![0.0; n + 1], vec![0.0; n + 1]);
        for i in 0..n {
            let gain = (a[i] + a[i + 1]) * dt / 2.0;
            v[i + 1] = velocity.min(18.0 * displacement / dt).min(v[i] + gain);
            let bend = (2.0 * a[i] + a[i + 1]) * dt * dt / 6.0;
            d[i + 1] = displacement.min(d[i] + v[i] * dt + bend);
            sum[i + 1] = sum[i] + chain.sums[i].s0 * a[i] + chain.sums[i].s1 * a[i + 1];
        }
        if l.rest == Rest::Both {
            v[n] = 0.0;
            for i in (0..n).rev() {
                v[i] = v[i].min(v[i + 1] + (a[i] + a[i + 1]) * dt / 2.0);
            }
        }
        Self { a, v, d, sum }
    }

    /// The same bound at every node: the largest.
    pub(super) fn everywhere(&self) -> Self {
        let flat = |bounds: &[f64]| vec![bounds.iter().copied().fold(0.0, f64::max); bounds.len()];
        Self { a: flat(&self.a), v: flat(&self.v), d: flat(&self.d), sum: flat(&self.sum) }
    }

    /// Sum of the largest `Σ α²` of each interval in `range`, each node at its bound.
    pub(super) fn sum_of_squares(&self, chain: &AxisChain, range: std::ops::Range<usize>) -> f64 {
        range
            .map(|i| {
                let (m, a, b) = (&chain.sums[i], self.a[i], self.a[i + 1]);
                m.m00 * a * a + 2.0 * m.m01 * a * b + m.m11 * b * b
            })
            .sum::<f64>()
            * (1.0 + 1e-12)
    }
}

/// One axis of a chain of intervals of equal duration.
#[derive(Debug, Clone)]
pub(crate) struct AxisChain {
    /// Duration of an interval, s.
    pub(crate) interval_s: f64,
    /// Samples of each interval.
    pub(crate) sums: Vec<IntervalSums>,
    /// The limits; they hold for all t.
    pub(crate) limits: AxisLimits,
    /// The motion variance is `V = Σ α² − (Σ α + shift)²/mass`.
    pub(crate) shift: f64,
    /// The divisor of the mean's term: at least the number of samples.
    pub(crate) mass: f64,
}

/// The states that pass from interval to interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct States {
    pub(super) velocity: bool,
    pub(super) displacement: bool,
    pub(super) sum: bool,
}

/// Largest number of iterations of each linear program.
const MAX_ITERATIONS: u32 = 50;

/// A linear form in the nodes' accelerations.
type Form = Vec<f64>;

fn combine(terms: &[(f64, &Form)]) -> Form {
    let mut sum = vec![0.0; terms[0].1.len()];
    for (factor, form) in terms {
        sum.iter_mut().zip(form.iter()).for_each(|(sum, x)| *sum += factor * x);
    }
    sum
}

impl StateBounds {
    /// The same bounds or smaller ones, from all limits together. Limits inside an interval act at the places
    /// `inside`.
    pub(super) fn tightened(&self, chain: &AxisChain, inside: &[f64], interruption: &Interruption) -> Self {
        let patience = Patience { max_iterations: MAX_ITERATIONS, interruption };
        let (n, dt, l) = (chain.sums.len(), chain.interval_s, &chain.limits);
        let node = |i: usize| -> Form { (0..=n).map(|k| f64::from(u8::from(k == i))).collect() };
        let (mut speeds, mut places) = (vec![vec![0.0; n + 1]], vec![vec![0.0; n + 1]]);
        let mut limited: Vec<(Form, f64)> = Vec::new();
        for i in 0..n {
            let a = node(i);
            let u = combine(&[(1.0 / dt, &node(i + 1)), (-1.0 / dt, &a)]);
            limited.extend(l.jerk.map(|limit| (u.clone(), limit)));
            limited.extend(l.intercept.map(|limit| (combine(&[(1.0, &a), (-(i as f64) * dt, &u)]), limit)));
            let velocity = |t: f64| combine(&[(1.0, &speeds[i]), (t, &a), (t * t / 2.0, &u)]);
            let displacement = |t: f64| {
                combine(&[(1.0, &places[i]), (t, &speeds[i]), (t * t / 2.0, &a), (t * t * t / 6.0, &u)])
            };
            for place in inside.iter().chain(&[1.0]) {
                limited.extend(l.velocity.map(|limit| (velocity(place * dt), limit)));
                limited.extend(l.displacement.map(|limit| (displacement(place * dt), limit)));
            }
            let (v, d) = (velocity(dt), displacement(dt));
            speeds.push(v);
            places.push(d);
        }

        // unknowns: the nodes, each divided by its bound
        let row = |constant: f64, form: &Form, factor: f64| Row {
            constant,
            terms: (0..=n).map(|k| (k, factor * form[k] * self.a[k])).filter(|term| term.1 != 0.0).collect(),
        };
        let mut program = MomentProgram { columns: n + 1, ..MomentProgram::default() };
        for (form, limit) in &limited {
            for sign in [1.0, -1.0] {
                program.nonnegative.push(row(1.0, form, sign / limit));
            }
        }
        for k in 0..=n {
            for sign in [1.0, -1.0] {
                program.nonnegative.push(Row { constant: 1.0, terms: vec![(k, sign)] });
            }
        }
        for (k, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value.filter(|_| self.a[k] > 0.0) {
                program.zero.push(row(-value / self.a[k], &node(k), 1.0 / self.a[k]));
            }
        }
        if l.rest == Rest::Both {
            program.zero.push(row(0.0, &speeds[n], 1.0 / dt));
        }
        let largest = |form: &Form, bound: f64| {
            if bound == 0.0 || !bound.is_finite() {
                return bound;
            }
            // limits are symmetric, but prescribed ends need not be
            let both = l.start.unwrap_or(0.0) != 0.0 || l.end.unwrap_or(0.0) != 0.0;
            let signs: &[f64] = if both { &[1.0, -1.0] } else { &[1.0] };
            let mut found = 0.0_f64;
            for sign in signs {
                let objective = row(0.0, form, sign / bound);
                let dual = program.bound_of(&objective, patience);
                found = found.max(dual.map_or(f64::INFINITY, |dual| dual.value));
            }
            bound.min(found.max(0.0) * bound)
        };
        let all = |forms: &[Form], bounds: &[f64]| -> Vec<f64> {
            forms.par_iter().zip(bounds).map(|(form, &bound)| largest(form, bound)).collect()
        };
        let nodes: Vec<Form> = (0..=n).map(node).collect();
        let mut tight = Self {
            a: all(&nodes, &self.a),
            v: all(&speeds, &self.v),
            d: all(&places, &self.d),
            sum: self.sum.clone(),
        };
        for i in 0..n {
            let gain = chain.sums[i].s0 * tight.a[i] + chain.sums[i].s1 * tight.a[i + 1];
            tight.sum[i + 1] = tight.sum[i] + gain;
        }
        tight
    }
}
