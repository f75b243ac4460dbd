//! Bound tightening: smaller bounds on nodes and states, by linear programs.
//!
//! Closed forms do not cover limits of many nodes that act together. Examples are how fast the velocity limit
//! lets the acceleration swing, and how far the displacement limit lets it go. The bounds scale every unknown
//! of the relaxation, and a tight scale is half of a tight relaxation.

use super::AxisChain;
use super::bounds::StateBounds;
use super::dual_bound::{MomentProgram, Patience, Row};
use crate::Interruption;
use calibrant_core::motion::Rest;
use rayon::prelude::*;

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
