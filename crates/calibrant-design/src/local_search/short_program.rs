//! The convex program of one iteration for a short motion: states eliminated, active set kept.
//!
//! `minimise g·δ + ½ δᵀ H δ + Σ c_i |u_i|` over the admissible motions `a + δ`, with H the positive part of
//! the criterion's second derivative. The variables are the nodes alone, divided by their natural size.
//!
//! Limits between the nodes are added as rows where the minimum breaks them, until it does not.
//!
//! Noise in proportion to the jerk has a kink at jerk zero, and good motions often have intervals there. So
//! each increment keeps its sign within one program. Where the minimum wants an increment of zero, its
//! multiplier tells whether the other sign is better: it then exceeds twice the weight `c` of the kink. The
//! sign is changed, and the program solved again. Each change lowers the minimum, so this ends.

use super::{Nodes, Part, SecondOrder};
use crate::convex::{Active, ActiveSet, LinearRow, Side};
use crate::limits::Region;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SVector};

/// Proximal weight, relative to the largest slope: at first, its factor after each full step, and at least.
/// It makes the program strictly convex. At first it also keeps its minimum near, since the first steps come
/// from afar and would change hundreds of active rows each.
const PROXIMAL: (f64, f64, f64) = (0.1, 0.2, 1e-4);
/// The least weight relative to the largest curvature.
const CURVATURE: f64 = 1e-10;
/// Rounds of rows between the nodes, and of changed signs.
const ROUNDS: usize = 60;

/// The limits of all axes as rows, and what the last program leaves for the next.
pub(crate) struct ShortProgram<const D: usize> {
    regions: [Region; D],
    rows: Vec<LinearRow>,
    /// Number of rows of the nodes; those after it are between nodes.
    permanent: usize,
    /// Bound of each increment, at `i D + k`. Its row has the same number.
    increments: Vec<f64>,
    active: Vec<Active>,
    multipliers: Vec<f64>,
    /// Signs of the increments.
    signs: Nodes<D>,
    proximal: f64,
}

impl<const D: usize> ShortProgram<D> {
    pub(crate) fn new(regions: &[Region; D]) -> Self {
        let intervals = regions[0].intervals();
        let mut rows = Vec::new();
        let mut increments = Vec::new();
        for i in 0..intervals {
            for (k, region) in regions.iter().enumerate() {
                let dt = region.tau[i + 1] - region.tau[i];
                let bound = region.limits.jerk.map_or(f64::INFINITY, |jerk| jerk * dt / region.size);
                let row = LinearRow::new(k * (intervals + 1) + i, vec![-1.0, 1.0], -bound, bound);
                increments.push(row.upper);
                rows.push(row);
            }
        }
        for (k, region) in regions.iter().enumerate() {
            rows.extend(region.node_rows(k * (intervals + 1)));
        }
        Self {
            regions: regions.clone(),
            permanent: rows.len(),
            rows,
            increments,
            active: Vec::new(),
            multipliers: Vec::new(),
            signs: vec![SVector::repeat(1.0); intervals],
            proximal: PROXIMAL.0,
        }
    }

    /// The admissible motion that minimises the model at `a`. Also the decrease of the model, relative to the
    /// most that the slope could promise.
    pub(crate) fn step<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        a: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, f64)> {
        self.take_signs(a);
        self.minimise(a, &part.second_order(a, &self.signs)?)
    }

    /// Learns what part of the way to the minimum was gone.
    pub(crate) fn moved(&mut self, fraction: f64) {
        if fraction == 1.0 {
            self.proximal = f64::max(self.proximal * PROXIMAL.1, PROXIMAL.2);
        }
    }

    /// Learns that the criterion does not fall on the way; returns whether another model may do better.
    pub(crate) fn blocked(&mut self) -> bool {
        let bold = self.proximal < PROXIMAL.0;
        self.proximal = PROXIMAL.0;
        bold
    }

    /// Takes over the signs of a motion's increments; those that are zero keep theirs.
    fn take_signs(&mut self, a: &[SVector<f64, D>]) {
        for (signs, pair) in self.signs.iter_mut().zip(a.windows(2)) {
            let step = pair[1] - pair[0];
            for k in 0..D {
                if step[k].abs() > 1e-9 * self.regions[k].size {
                    signs[k] = step[k].signum();
                }
            }
        }
    }

    fn minimise(&mut self, a: &[SVector<f64, D>], model: &SecondOrder<D>) -> Option<(Nodes<D>, f64)> {
        // the variables are sorted by axis, the model by node
        let (nodes, unknowns) = (a.len(), a.len() * D);
        let size = |at: usize| self.regions[at / nodes].size;
        let place = |at: usize| at % nodes * D + at / nodes;
        let here = DVector::from_fn(unknowns, |at, _| a[at % nodes][at / nodes] / size(at));
        let slope = DVector::from_fn(unknowns, |at, _| model.slope[place(at)] * size(at));
        let reach = slope.iter().map(|s| s.abs()).sum::<f64>();
        if reach.is_nan() || reach <= 0.0 {
            return Some((a.to_vec(), 0.0));
        }
        let slope = slope / reach;
        let hessian = DMatrix::from_fn(unknowns, unknowns, |i, j| {
            model.hessian[(place(i), place(j))] * size(i) * size(j) / reach
        });
        let kinks: Vec<f64> =
            model.kinks.iter().enumerate().map(|(at, c)| c * self.regions[at % D].size / reach).collect();
        let hessian = positive_part(hessian);
        let mut convex = hessian.clone();
        let proximal = self.proximal * slope.amax() + CURVATURE * hessian.diagonal().amax();
        (0..unknowns).for_each(|k| convex[(k, k)] += proximal);
        let factor = convex.clone().cholesky()?;

        let before = self.signs.clone();
        let linear = &slope - &convex * &here;
        let mut x = self.with_limits(&factor, &linear, !kinks.is_empty())?;
        for round in 0.. {
            if kinks.is_empty() || !self.change_signs(&kinks) {
                break;
            }
            if round == ROUNDS {
                return None;
            }
            // the kinks count from the signs at which the slope was taken
            let mut linear = linear.clone();
            for (at, c) in kinks.iter().enumerate() {
                let change = (self.signs[at / D][at % D] - before[at / D][at % D]) * c;
                linear[at % D * nodes + at / D] -= change;
                linear[at % D * nodes + at / D + 1] += change;
            }
            x = self.with_limits(&factor, &linear, true)?;
        }
        let step = &x - &here;
        let mut change = slope.dot(&step) + step.dot(&(&hessian * &step)) / 2.0;
        for (at, c) in kinks.iter().enumerate() {
            let first = at % D * nodes + at / D;
            let increment = x[first + 1] - x[first];
            change += c * (increment.abs() - before[at / D][at % D] * increment);
        }
        let target =
            (0..nodes).map(|i| SVector::from_fn(|k, _| x[k * nodes + i] * self.regions[k].size)).collect();
        Some((target, -change))
    }

    /// The minimum within all limits, at all times; `signed` where increments keep their signs.
    fn with_limits(
        &mut self,
        factor: &Cholesky<f64, Dyn>,
        linear: &DVector<f64>,
        signed: bool,
    ) -> Option<DVector<f64>> {
        for (at, (row, &bound)) in self.rows.iter_mut().zip(&self.increments).enumerate() {
            let sign = if signed { self.signs[at / D][at % D] } else { 0.0 };
            row.lower = if sign > 0.0 { 0.0 } else { -bound };
            row.upper = if sign < 0.0 { 0.0 } else { bound };
        }
        let mut set = ActiveSet::begin(factor, linear.clone(), &self.rows, &self.active)?;
        let mut result = None;
        for _ in 0..ROUNDS {
            set.solve(&self.rows)?;
            let x = set.x();
            let mut news = Vec::new();
            for (k, region) in self.regions.iter().enumerate() {
                let (first, nodes) = (k * (region.intervals() + 1), region.intervals() + 1);
                let own: Vec<f64> = x.rows(first, nodes).iter().map(|x| x * region.size).collect();
                news.extend(region.rows_inside(&own, first));
            }
            if news.is_empty() {
                result = Some(x.clone());
                break;
            }
            self.rows.extend(news);
        }
        // rows between the nodes stay while they are active
        let mut kept: Vec<LinearRow> = Vec::new();
        self.multipliers.clear();
        self.active = set
            .active()
            .map(|((row, side), multiplier)| {
                let row = if row < self.permanent {
                    row
                } else {
                    kept.push(self.rows[row].clone());
                    self.permanent + kept.len() - 1
                };
                self.multipliers.push(multiplier);
                (row, side)
            })
            .collect();
        self.rows.truncate(self.permanent);
        self.rows.extend(kept);
        result
    }

    /// Changes the sign of the increments that are held at zero against more than the weight of their kink.
    fn change_signs(&mut self, kinks: &[f64]) -> bool {
        let mut changed = false;
        for (&(row, side), &multiplier) in self.active.iter().zip(&self.multipliers) {
            if row >= self.increments.len() {
                continue;
            }
            let sign = &mut self.signs[row / D][row % D];
            let held = if *sign > 0.0 { Side::Lower } else { Side::Upper };
            if side == held && multiplier / std::f64::consts::SQRT_2 > 2.0 * kinks[row] * (1.0 + 1e-9) + 1e-14
            {
                *sign = -*sign;
                changed = true;
            }
        }
        changed
    }
}

/// The nearest positive semidefinite matrix.
fn positive_part(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let eigen = matrix.symmetric_eigen();
    let mut vectors = eigen.eigenvectors.clone();
    for (mut column, value) in vectors.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column *= value.max(0.0);
    }
    vectors * eigen.eigenvectors.transpose()
}
