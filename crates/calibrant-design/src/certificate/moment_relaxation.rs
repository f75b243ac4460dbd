//! The sparse moment relaxation of a chain of intervals. It makes a nonconvex maximum a semidefinite program.
//!
//! The motion variance is a quadratic of the motion; its maximum over the admissible motions is a nonconvex
//! problem. In place of one motion, take a distribution of motions. The mean variance is then linear in the
//! moments of the distribution. Moments up to a degree satisfy convex conditions. The largest value over all
//! vectors that satisfy them bounds the motion variance from above. The conditions are:
//!
//! - The moment matrix of `(1, z, z²)`, or up to `z³`, is positive semidefinite, for the few variables z of a
//!   clique of intervals. These are its nodes and the states that the limits need at its start (velocity,
//!   displacement, the running sum of the samples).
//! - For every limit `|ℓ(z)| ≤ 1`, the matrix of one degree less, weighted with `1 − ℓ²`, is positive
//!   semidefinite. Limits that hold for all t hold at the quarters of each interval.
//! - With moments up to the fourth degree, `(1 − ℓ²)(1 − k²)` has no negative mean for any two limits. With
//!   those up to the sixth degree these add nothing that pays for their time.
//! - Two neighbours agree on all moments of the node and the states that they share.
//!
//! Every variable is divided by a bound of its own, so that no moment exceeds one in size. Where a motion and
//! its mirror image −a are equivalent, the distribution may be taken symmetric. Odd moments then vanish and
//! every matrix falls into two.
//!
//! # References
//! `lasserre2001`, `waki2006`

use super::bounds::StateBounds;
use super::dual_bound::MomentProgram;
use super::polynomial::{Monomial, Polynomial, VARIABLES, degree, monomials};
use super::{AxisChain, States};
use crate::convex::Row;
use calibrant_core::motion::Rest;
use std::collections::BTreeMap;
use std::ops::Range;

/// The part of the chain that is relaxed, and how.
#[derive(Debug, Clone)]
pub(super) struct ChainPart<'a> {
    pub(super) chain: &'a AxisChain,
    pub(super) bounds: &'a StateBounds,
    /// Intervals.
    pub(super) range: Range<usize>,
    /// Largest number of variables of a clique: it combines as many intervals as they allow.
    pub(super) variables: usize,
    pub(super) states: States,
    /// Is the part cut from a longer chain, so that it starts and ends anywhere?
    pub(super) open: bool,
    /// Places inside each interval at which limits are imposed.
    pub(super) inside: &'a [f64],
    /// Half the highest degree of a moment, at least 2.
    pub(super) order: u8,
}

/// Some intervals that are combined: their quantities as polynomials of scaled variables.
struct Clique {
    variables: usize,
    /// Column of each moment.
    columns: BTreeMap<Monomial, usize>,
    /// Nodes and states shared with the clique before, each divided by its bound.
    entry: Vec<Polynomial>,
    /// Nodes and states shared with the next clique, divided by the same bounds.
    exit: Vec<Polynomial>,
    /// Forms `|ℓ| ≤ 1`.
    forms: Vec<Polynomial>,
    /// Its part of the motion variance.
    objective: Polynomial,
}

/// The number of variables of a clique that have a name so far.
#[derive(Default)]
struct Variables(usize);

impl Variables {
    /// A quantity of at most this size.
    fn add(&mut self, bound: f64) -> Polynomial {
        if bound == 0.0 {
            return Polynomial::default();
        }
        self.0 += 1;
        // too many for a clique: the caller counts them
        if self.0 > VARIABLES { Polynomial::default() } else { Polynomial::variable(self.0 - 1, bound) }
    }
}

impl ChainPart<'_> {
    /// The relaxation, its objective divided by `scale`. `None` where a quantity that it needs is not bounded
    /// or nothing is free.
    pub(super) fn relax(&self, scale: f64) -> Option<MomentProgram> {
        let symmetric = self.is_symmetric();
        let mut program = MomentProgram::default();
        let mut before: Option<Clique> = None;
        for range in self.cliques() {
            let mut clique = self.clique(range)?;
            let first = program.columns;
            for monomial in monomials(clique.variables, 2 * self.order) {
                let degree = degree(&monomial);
                if degree > 0 && !(symmetric && degree % 2 == 1) {
                    clique.columns.insert(monomial, program.columns);
                    if monomial.iter().all(|exponent| exponent % 2 == 0) {
                        program.squares.push(program.columns);
                    }
                    program.columns += 1;
                }
            }
            program.cliques.push(first..program.columns);
            clique.require_moments(&mut program, symmetric, self.order);
            if let Some(before) = &before {
                agree(before, &clique, &mut program, symmetric, self.order);
            }
            let part = clique.mean(&clique.objective.scaled(1.0 / scale));
            program.objective.constant += part.constant;
            program.objective.terms.extend(part.terms);
            before = Some(clique);
        }
        (program.columns > 0).then_some(program)
    }

    fn is_symmetric(&self) -> bool {
        let l = &self.chain.limits;
        let fixed = !self.open && (l.start.unwrap_or(0.0) != 0.0 || l.end.unwrap_or(0.0) != 0.0);
        let shifted = self.states.sum && self.chain.shift != 0.0;
        !fixed && !shifted
    }

    /// The intervals of each clique. States are zero at the start and so are some at the end: cliques there
    /// are longer.
    fn cliques(&self) -> Vec<Range<usize>> {
        let mut all = Vec::new();
        let mut first = self.range.start;
        while first < self.range.end {
            let fits = |end: &usize| {
                let mut variables = Variables::default();
                self.motion(first..*end, &mut variables).is_some() && variables.0 <= self.variables
            };
            let end = (first + 1..=self.range.end).take_while(|end| *end == first + 1 || fits(end)).last();
            // the end may need fewer variables than the intervals before it
            let end = Some(self.range.end).filter(fits).or(end).unwrap_or(self.range.end);
            all.push(first..end);
            first = end;
        }
        all
    }

    /// The clique of these intervals.
    fn clique(&self, range: Range<usize>) -> Option<Clique> {
        let (chain, bounds, states) = (self.chain, self.bounds, self.states);
        let (i, width) = (range.start, range.len());
        let (dt, l) = (chain.interval_s, &chain.limits);
        let last = range.end == self.range.end && !self.open;
        let mut variables = Variables::default();
        let Motion { nodes, v, d, sum } = self.motion(range, &mut variables)?;

        let mut limited = Vec::new();
        let (mut speeds, mut places, mut totals) = (vec![v], vec![d], vec![sum]);
        for k in 0..=width {
            limited.push((nodes[k].clone(), bounds.a[i + k]));
            if states.velocity {
                limited.push((speeds[k].clone(), bounds.v[i + k]));
            }
            if states.displacement {
                limited.push((places[k].clone(), bounds.d[i + k]));
            }
            if k == width {
                break;
            }
            let (a, v, d) = (&nodes[k], &speeds[k], &places[k]);
            let u = nodes[k + 1].plus(-1.0, a).scaled(1.0 / dt);
            limited.extend(l.jerk.map(|limit| (u.clone(), limit)));
            let tau = (i + k) as f64 * dt;
            limited.extend(l.intercept.map(|limit| (a.plus(-tau, &u), limit)));
            let velocity = |t: f64| v.plus(t, a).plus(t * t / 2.0, &u);
            let displacement = |t: f64| d.plus(t, v).plus(t * t / 2.0, a).plus(t * t * t / 6.0, &u);
            for t in self.inside.iter().map(|place| place * dt) {
                limited.extend(l.velocity.filter(|_| states.velocity).map(|limit| (velocity(t), limit)));
                limited.extend(
                    l.displacement.filter(|_| states.displacement).map(|limit| (displacement(t), limit)),
                );
            }
            let m = &chain.sums[i + k];
            let (v, d) = (velocity(dt), displacement(dt));
            totals.push(totals[k].plus(m.s0, a).plus(m.s1, &nodes[k + 1]));
            speeds.push(v);
            places.push(d);
        }

        let mut forms: Vec<_> = (0..variables.0).map(|k| Polynomial::variable(k, 1.0)).collect();
        for (form, limit) in limited {
            let form = form.scaled(1.0 / limit);
            // a form that the bounds of the variables imply adds nothing; a limit of zero is an equality that
            // is there already
            if limit > 0.0 && limit.is_finite() && form.bounds() > 1.0 + 1e-9 {
                forms.push(form);
            }
        }
        let mut objective = Polynomial::default();
        for k in 0..width {
            let (m, a, b) = (&chain.sums[i + k], &nodes[k], &nodes[k + 1]);
            objective =
                objective.plus(m.m00, &a.times(a)).plus(2.0 * m.m01, &a.times(b)).plus(m.m11, &b.times(b));
        }
        if states.sum && last {
            let total = totals[width].plus(1.0, &Polynomial::constant(chain.shift));
            objective = objective.plus(-1.0 / chain.mass, &total.times(&total));
        }
        // node k and the states there
        let shared = |k: usize| {
            let scaled = |quantity: &Polynomial, bound: f64| {
                quantity.scaled(if bound > 0.0 { 1.0 / bound } else { 1.0 })
            };
            let mut all = vec![scaled(&nodes[k], bounds.a[i + k])];
            all.extend(states.velocity.then(|| scaled(&speeds[k], bounds.v[i + k])));
            all.extend(states.displacement.then(|| scaled(&places[k], bounds.d[i + k])));
            all.extend(states.sum.then(|| scaled(&totals[k], bounds.sum[i + k])));
            all
        };
        let (entry, exit) = (shared(0), shared(width));
        let bounded = forms.iter().chain(&entry).chain(&exit).all(|form| form.bounds().is_finite());
        (bounded && variables.0 <= VARIABLES).then(|| Clique {
            variables: variables.0,
            columns: BTreeMap::new(),
            entry,
            exit,
            forms,
            objective,
        })
    }

    /// Names the variables. A value that is prescribed, or follows from rest at the end, is not a variable.
    fn motion(&self, range: Range<usize>, variables: &mut Variables) -> Option<Motion> {
        let (bounds, states) = (self.bounds, self.states);
        let (i, width) = (range.start, range.len());
        let first = i == self.range.start && !self.open;
        let last = range.end == self.range.end && !self.open;
        let (dt, l) = (self.chain.interval_s, &self.chain.limits);
        let start = if first { l.start } else { None };
        let end = if last { l.end } else { None };
        let stops = last && l.rest == Rest::Both;
        if first && last && stops && end.is_some() {
            return None;
        }
        let state = |wanted: bool, bound: f64, variables: &mut Variables| {
            if wanted && !first { variables.add(bound) } else { Polynomial::default() }
        };
        let mut nodes: Vec<Polynomial> = Vec::new();
        let mut v = Polynomial::default();
        if !(stops && end.is_some()) {
            v = state(states.velocity, bounds.v[i], variables);
        }
        let d = state(states.displacement, bounds.d[i], variables);
        let sum = state(states.sum, bounds.sum[i], variables);
        if let (Some(limit), None, None, false) = (l.intercept, start, end, stops) {
            // the thesis's variables: the limits act on them, and nodes far from t = 0 would be badly scaled
            let x = variables.add(limit);
            for k in 0..width {
                let bound = l.jerk.unwrap_or(f64::INFINITY).min((bounds.a[i + k] + bounds.a[i + k + 1]) / dt);
                let u = variables.add(bound);
                let tau = i as f64 * dt;
                if k == 0 {
                    nodes.push(x.plus(tau, &u));
                }
                nodes.push(nodes[k].plus(dt, &u));
            }
            return Some(Motion { nodes, v, d, sum });
        }
        for k in 0..=width {
            nodes.push(match (start, end) {
                (Some(value), _) if k == 0 => Polynomial::constant(value),
                (_, Some(value)) if k == width => Polynomial::constant(value),
                _ if k == width && stops => Polynomial::default(),
                _ => variables.add(bounds.a[i + k]),
            });
        }
        if stops {
            // v + Δτ (a_0/2 + a_1 + … + a_w/2) = 0
            let mut gain = nodes[0].plus(1.0, &nodes[width]).scaled(dt / 2.0);
            for node in &nodes[1..width] {
                gain = gain.plus(dt, node);
            }
            if end.is_some() {
                v = gain.scaled(-1.0);
            } else {
                nodes[width] = v.plus(1.0, &gain).scaled(-2.0 / dt);
            }
        }
        Some(Motion { nodes, v, d, sum })
    }
}

/// The nodes of a clique and the states at its start.
struct Motion {
    nodes: Vec<Polynomial>,
    v: Polynomial,
    d: Polynomial,
    sum: Polynomial,
}

impl Clique {
    /// The mean of a polynomial, in the moments.
    fn mean(&self, polynomial: &Polynomial) -> Row {
        self.mean_with(polynomial, &[0; VARIABLES])
    }

    /// The mean of a polynomial times a monomial.
    fn mean_with(&self, polynomial: &Polynomial, factor: &Monomial) -> Row {
        let mut row = Row::default();
        for (own, coefficient) in polynomial.terms() {
            let monomial = std::array::from_fn(|k| own[k] + factor[k]);
            if degree(&monomial) == 0 {
                row.constant += coefficient;
            } else if let Some(&column) = self.columns.get(&monomial) {
                row.terms.push((column, coefficient));
            }
        }
        row
    }

    fn require_moments(&self, program: &mut MomentProgram, symmetric: bool, order: u8) {
        let one = Polynomial::constant(1.0);
        self.require_matrix(program, &one, &monomials(self.variables, order), symmetric);
        let slacks: Vec<_> = self.forms.iter().map(Polynomial::slack).collect();
        for (k, slack) in slacks.iter().enumerate() {
            self.require_matrix(program, slack, &monomials(self.variables, order - 1), symmetric);
            if order == 2 {
                for other in &slacks[..=k] {
                    program.nonnegative.push(self.mean(&slack.times(other)));
                }
            }
        }
    }

    /// The moment matrix of `basis`, weighted with a polynomial; with `split`, even and odd monomials apart.
    fn require_matrix(
        &self,
        program: &mut MomentProgram,
        weight: &Polynomial,
        basis: &[Monomial],
        split: bool,
    ) {
        let parts: Vec<Vec<Monomial>> = if split {
            [0, 1].map(|odd| basis.iter().filter(|m| degree(m) % 2 == odd).copied().collect()).into()
        } else {
            vec![basis.to_vec()]
        };
        for part in parts {
            let mut triangle = Vec::new();
            for (j, right) in part.iter().enumerate() {
                for left in &part[..=j] {
                    let monomial = std::array::from_fn(|k| left[k] + right[k]);
                    triangle.push(self.mean_with(weight, &monomial));
                }
            }
            match part.len() {
                0 => {}
                1 => program.nonnegative.append(&mut triangle),
                size => program.semidefinite.push((size, triangle)),
            }
        }
    }
}

/// Neighbours agree on the moments of what they share.
fn agree(before: &Clique, after: &Clique, program: &mut MomentProgram, symmetric: bool, order: u8) {
    for monomial in monomials(before.exit.len(), 2 * order) {
        let degree = degree(&monomial);
        if degree == 0 || (symmetric && degree % 2 == 1) {
            continue;
        }
        let power = |quantities: &[Polynomial]| {
            quantities.iter().zip(monomial).fold(
                Polynomial::constant(1.0),
                |product, (quantity, exponent)| {
                    (0..exponent).fold(product, |product, _| product.times(quantity))
                },
            )
        };
        let mut row = before.mean(&power(&before.exit));
        let other = after.mean(&power(&after.entry));
        row.constant -= other.constant;
        row.terms.extend(other.terms.iter().map(|&(column, coefficient)| (column, -coefficient)));
        if !row.terms.is_empty() {
            program.zero.push(row);
        }
    }
}
