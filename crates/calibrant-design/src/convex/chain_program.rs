//! An interior-point method for quadratic programs on chains, one for each axis, that a few forms tie together.
//!
//! `minimise Σ slope·z + ½ Σ square s² + ½ Σ_k (b_k·a − o_k)² − t` subject to `c·z ≤ bound` for the rows of each
//! stage, with the stages of [`crate::convex::chain_factor`]. The forms `b_k` are dense, but few. Where there is a matrix,
//! t is its smallest eigenvalue ([`crate::convex::eigenvalue_cone`]).
//!
//! # Method
//! Mehrotra's predictor and corrector. The start is inside all rows, and stays there, so the equations are
//!
//! `H dx + Cᵀ dy = −∇ − Cᵀ y`, `t = bound − C x`, `t dy + y dt = σ μ − t y − dt° dy°`
//!
//! with the predictor `dt°, dy°`. Without dy: `(H + Cᵀ diag(y/t) C) dx = −∇ − Cᵀ (σ μ − dt° dy°)/t`. The rows of a
//! stage touch that stage alone, so but for the forms the matrix is one of chains, with a factor in O(N). The forms
//! and the conditions on the last states border it:
//!
//! `[[K, Gᵀ], [G, −Δ]]`, `Δ = 1` for a form and 0 for a condition,
//!
//! and are eliminated by their Schur complement `Δ + G K⁻¹ Gᵀ`. An iteration takes O(N) for each form. The cone of a
//! matrix adds forms to the border, and the unknown t to its Schur complement.
//!
//! # References
//! `mehrotra1992`, `rao1998`, `wright1997`

use super::{AffineMatrix, ChainFactor, Cone, ConeStep, Scaling, Stage, StageWeight, Transition, triangle};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Vector3};
use std::borrow::Cow;

/// The condition `c·z ≤ bound` on a stage.
#[derive(Debug, Clone)]
pub(crate) struct StageRow {
    pub(crate) stage: usize,
    pub(crate) c: Stage,
    pub(crate) bound: f64,
}

/// The stages of one axis, its limits and its part of the objective.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    pub(crate) transitions: Vec<Transition>,
    /// Is the first acceleration free?
    pub(crate) free: bool,
    pub(crate) rows: Vec<StageRow>,
    /// Forms of the last state that keep their value.
    pub(crate) held: Vec<Vector3<f64>>,
    pub(crate) slope: Vec<Stage>,
    /// Weight of the square of s.
    pub(crate) square: Vec<f64>,
}

/// A form of the accelerations, by chain and node: `½ (b·a − offset)²`.
#[derive(Debug, Clone)]
pub(crate) struct Form {
    pub(crate) b: Vec<Vec<f64>>,
    pub(crate) offset: f64,
}

/// The program.
pub(crate) struct ChainProgram {
    pub(crate) chains: Vec<Chain>,
    pub(crate) forms: Vec<Form>,
    /// Its smallest eigenvalue is maximised.
    pub(crate) matrix: Option<AffineMatrix>,
    /// An objective that is reached already: a solution need not be better than a share of what it gains.
    pub(crate) reached: f64,
}

/// The stages of every chain.
pub(crate) type Stages = Vec<Vec<Stage>>;

/// Largest gap of a solution: absolute, and relative to what was gained.
const GAP: (f64, f64) = (1e-10, 1e-2);
/// Share of the way to the boundary.
const BOUNDARY: f64 = 0.995;
/// Largest share of the first residual of the gradient that may remain; with a cone, that of the gap.
const RESIDUAL: f64 = 1e-7;
/// Weight of the accelerations in the factorisation, against singular matrices.
const REGULAR: f64 = 1e-13;
/// A step of less than this share of the way is rounding.
const STUCK: f64 = 1e-6;
const ITERATIONS: usize = 60;

/// What the method finds.
#[derive(Debug, Clone)]
pub(crate) struct ChainSolution {
    pub(crate) stages: Stages,
    /// By how much the objective is lower than the one that was reached already.
    pub(crate) gained: f64,
    /// By how much it may still be above the minimum.
    pub(crate) gap: f64,
    /// Number of iterations.
    #[cfg(test)]
    pub(crate) iterations: usize,
    /// The multiplier of the matrix.
    #[cfg(test)]
    pub(crate) multiplier: Option<DMatrix<f64>>,
}

impl ChainProgram {
    /// The minimum from a point inside all rows, at which the gap is to be `gap`. `None` where the start is not
    /// inside. Where rounding prevails, the solution has a larger gap than it should.
    pub(crate) fn solve(&self, start: Stages, gap: f64) -> Option<ChainSolution> {
        let mut x = start;
        let mut slack = self.rows(&x);
        slack.iter_mut().zip(self.bounds()).for_each(|(t, bound)| *t = bound - *t);
        let size = self.matrix.as_ref().map_or(0, AffineMatrix::size);
        let count = (slack.len() + size) as f64;
        if slack.iter().any(|&t| t.is_nan() || t <= 0.0) {
            return None;
        }
        let mut multipliers: Vec<f64> = slack.iter().map(|t| gap / count / t).collect();
        let mut cone = match &self.matrix {
            Some(matrix) => Some(Cone::new(matrix, &x, gap / count)?),
            None => None,
        };
        let mut residual = 1.0;
        for iterations in 0.. {
            let gap = dot(&slack, &multipliers) + cone.as_ref().map_or(0.0, Cone::gap);
            let mean = gap / count;
            let forms = self.forms_at(&x);
            let eigenvalue = cone.as_ref().map_or(0.0, |cone| cone.t);
            let gained = self.reached - self.objective(&x, &forms) + eigenvalue;
            let ended = |stages| ChainSolution {
                stages,
                gained,
                gap: gap + residual,
                #[cfg(test)]
                iterations,
                #[cfg(test)]
                multiplier: cone.as_ref().map(|cone| cone.multiplier().clone()),
            };
            let remains = if cone.is_some() { GAP.0 } else { RESIDUAL };
            let done = residual <= remains && gap <= GAP.0 + GAP.1 * gained.max(0.0);
            let newton = if done || iterations == ITERATIONS {
                None
            } else {
                self.newton(&slack, &multipliers, cone.as_ref())
            };
            let Some(newton) = newton else {
                return Some(ended(x));
            };
            let gradient = self.gradient(&x, &forms);
            let direction = |centre: &dyn Fn(usize) -> f64, cone: Option<(f64, &ConeStep)>| {
                let mut step = gradient.clone();
                step.iter_mut().flatten().for_each(|g| *g = -*g);
                let pull: Vec<f64> = slack.iter().enumerate().map(|(k, t)| centre(k) / t).collect();
                self.add_rows(&mut step, &pull, -1.0);
                let cone = newton.solve(&mut step, cone);
                let along = self.rows(&step);
                let rise: Vec<f64> = (0..slack.len())
                    .map(|k| pull[k] - multipliers[k] + multipliers[k] / slack[k] * along[k])
                    .collect();
                let fall: Vec<f64> = along.iter().map(|along| -along).collect();
                Direction { step, fall, rise, cone }
            };
            let furthest = |direction: &Direction| {
                let cone = newton.scaling().zip(direction.cone.as_ref());
                let cone = cone.map_or(f64::INFINITY, |(scaling, step)| scaling.furthest(step));
                furthest(&slack, &direction.fall).min(furthest(&multipliers, &direction.rise)).min(cone)
            };
            let predictor = direction(&|_| 0.0, None);
            let most = furthest(&predictor).min(1.0);
            let Direction { fall, rise, cone: of_cone, .. } = &predictor;
            let after: f64 = (0..slack.len())
                .map(|k| (slack[k] + most * fall[k]) * (multipliers[k] + most * rise[k]))
                .sum();
            let of_cone = newton.scaling().zip(of_cone.as_ref());
            let after = after + of_cone.map_or(0.0, |(scaling, step)| scaling.gap_after(step, most));
            let centre = (after / count / mean).powi(3) * mean;
            let of_cone = predictor.cone.as_ref().map(|step| (centre, step));
            let corrected = direction(&|k| centre - fall[k] * rise[k], of_cone);
            let most = (BOUNDARY * furthest(&corrected)).min(1.0);
            if most.is_nan() || most < STUCK {
                return Some(ended(x));
            }
            for (x, step) in x.iter_mut().flatten().zip(corrected.step.iter().flatten()) {
                *x += step * most;
            }
            for k in 0..slack.len() {
                slack[k] += most * corrected.fall[k];
                multipliers[k] += most * corrected.rise[k];
            }
            if let (Some(cone), Some(matrix)) = (&mut cone, &self.matrix)
                && let Some((scaling, step)) = newton.scaling().zip(corrected.cone.as_ref())
            {
                cone.advance(scaling, step, most, matrix, &x);
            }
            residual *= 1.0 - most;
        }
        None
    }

    fn bounds(&self) -> impl Iterator<Item = f64> + '_ {
        self.chains.iter().flat_map(|chain| chain.rows.iter().map(|row| row.bound))
    }

    /// `c·z` for every row.
    fn rows(&self, x: &Stages) -> Vec<f64> {
        let of = |(chain, x): (&Chain, &Vec<Stage>)| -> Vec<f64> {
            chain.rows.iter().map(|row| row.c.dot(&x[row.stage])).collect()
        };
        self.chains.iter().zip(x).flat_map(of).collect()
    }

    /// `b·a − offset` for every form.
    pub(crate) fn forms_at(&self, x: &Stages) -> Vec<f64> {
        self.forms.iter().map(|form| form.at(x) - form.offset).collect()
    }

    /// The objective, with the values of its forms.
    pub(crate) fn objective(&self, x: &Stages, forms: &[f64]) -> f64 {
        let own = |(chain, x): (&Chain, &Vec<Stage>)| -> f64 {
            let linear: f64 = chain.slope.iter().zip(x).map(|(slope, z)| slope.dot(z)).sum();
            let squares: f64 = chain.square.iter().zip(x).map(|(square, z)| square * z[4] * z[4]).sum();
            linear + squares / 2.0
        };
        self.chains.iter().zip(x).map(own).sum::<f64>() + dot(forms, forms) / 2.0
    }

    fn gradient(&self, x: &Stages, forms: &[f64]) -> Stages {
        let mut gradient: Stages = self.chains.iter().map(|chain| chain.slope.clone()).collect();
        for ((gradient, chain), x) in gradient.iter_mut().zip(&self.chains).zip(x) {
            for ((g, square), z) in gradient.iter_mut().zip(&chain.square).zip(x) {
                g[4] += square * z[4];
            }
        }
        for (form, value) in self.forms.iter().zip(forms) {
            form.add_to(&mut gradient, *value);
        }
        gradient
    }

    /// Adds `factor Cᵀ y`.
    fn add_rows(&self, to: &mut Stages, y: &[f64], factor: f64) {
        let mut at = 0;
        for (to, chain) in to.iter_mut().zip(&self.chains) {
            for row in &chain.rows {
                to[row.stage] += row.c * (factor * y[at]);
                at += 1;
            }
        }
    }

    /// The factor of `H + Cᵀ diag(y/t) C` with the conditions on the last states.
    fn newton(&self, slack: &[f64], multipliers: &[f64], cone: Option<&Cone>) -> Option<Newton<'_>> {
        let mut at = 0;
        let mut factors = Vec::new();
        for chain in &self.chains {
            let nodes = chain.transitions.len() + 1;
            let mut weights = vec![StageWeight::zeros(); nodes];
            for (i, weight) in weights.iter_mut().enumerate() {
                weight[(0, 0)] = REGULAR;
                weight[(4, 4)] = chain.square.get(i).copied().unwrap_or(0.0);
            }
            for row in &chain.rows {
                let ratio = multipliers[at] / slack[at];
                at += 1;
                let weight = &mut weights[row.stage];
                for j in (0..5).filter(|&j| row.c[j] != 0.0) {
                    for k in 0..5 {
                        weight[(k, j)] += ratio * row.c[j] * row.c[k];
                    }
                }
            }
            factors.push(ChainFactor::new(&chain.transitions, &weights, chain.free)?);
        }
        let scaled = match (cone, &self.matrix) {
            (Some(cone), Some(matrix)) => Some(ScaledMatrix::new(cone.scaling()?, matrix)),
            _ => None,
        };
        let schur = DMatrix::identity(0, 0).cholesky()?;
        let mut newton = Newton { factors, border: Vec::new(), schur, cone: None };
        newton.border.extend(self.forms.iter().map(|form| Row::Form(Cow::Borrowed(form))));
        let first = newton.border.len();
        newton.cone = scaled.map(|ScaledMatrix { scaling, metric, forms }| {
            newton.border.extend(forms.into_iter().map(|form| Row::Form(Cow::Owned(form))));
            BorderedCone { scaling, metric, first }
        });
        for (number, chain) in self.chains.iter().enumerate() {
            newton.border.extend(chain.held.iter().map(|held| Row::Held(number, *held)));
        }
        let size = newton.border.len();
        let mut schur = DMatrix::zeros(size, size);
        for (k, row) in newton.border.iter().enumerate() {
            let mut column = self.zeros();
            row.add_to(&mut column, 1.0);
            newton.chains(&mut column);
            for (j, row) in newton.border[..=k].iter().enumerate() {
                schur[(k, j)] = row.at(&column);
            }
            if let Row::Form(_) = row {
                schur[(k, k)] += 1.0;
            }
        }
        // only the lower triangle is read
        newton.schur = schur.cholesky()?;
        Some(newton)
    }

    fn zeros(&self) -> Stages {
        self.chains.iter().map(|chain| vec![Stage::zeros(); chain.transitions.len() + 1]).collect()
    }
}

impl Form {
    pub(crate) fn at(&self, x: &Stages) -> f64 {
        self.b.iter().flatten().zip(x.iter().flatten()).map(|(b, z)| b * z[0]).sum()
    }

    fn add_to(&self, x: &mut Stages, factor: f64) {
        self.b.iter().flatten().zip(x.iter_mut().flatten()).for_each(|(b, z)| z[0] += factor * b);
    }
}

/// A direction: of the stages, the slacks, the multipliers and the cone.
struct Direction {
    step: Stages,
    fall: Vec<f64>,
    rise: Vec<f64>,
    cone: Option<ConeStep>,
}

/// A matrix in the scaling of the cone: its entries are forms of the accelerations.
struct ScaledMatrix {
    scaling: Scaling,
    metric: Vec<f64>,
    forms: Vec<Form>,
}

impl ScaledMatrix {
    fn new(scaling: Scaling, matrix: &AffineMatrix) -> Self {
        let metric = scaling.entries(&matrix.metric);
        let b: Vec<Vec<f64>> = matrix.changes.iter().map(|changes| vec![0.0; changes.len()]).collect();
        let mut forms = vec![Form { b, offset: 0.0 }; metric.len()];
        for (k, changes) in matrix.changes.iter().enumerate() {
            for (i, change) in changes.iter().enumerate() {
                for (form, entry) in forms.iter_mut().zip(scaling.entries(change)) {
                    form.b[k][i] = entry;
                }
            }
        }
        Self { scaling, metric, forms }
    }
}

/// The cone on the border, from row `first` on, with the scaled entries of its metric.
struct BorderedCone {
    scaling: Scaling,
    metric: Vec<f64>,
    first: usize,
}

/// A row of the border.
enum Row<'a> {
    Form(Cow<'a, Form>),
    Held(usize, Vector3<f64>),
}

impl Row<'_> {
    fn at(&self, x: &Stages) -> f64 {
        match self {
            Self::Form(form) => form.at(x),
            Self::Held(chain, held) => {
                x[*chain].last().map_or(0.0, |last| held.dot(&last.fixed_rows::<3>(0)))
            }
        }
    }

    fn add_to(&self, x: &mut Stages, factor: f64) {
        match self {
            Self::Form(form) => form.add_to(x, factor),
            Self::Held(chain, held) => {
                if let Some(last) = x[*chain].last_mut() {
                    (0..3).for_each(|k| last[k] += factor * held[k]);
                }
            }
        }
    }
}

/// The factorised matrix of one iteration.
struct Newton<'a> {
    factors: Vec<ChainFactor<'a>>,
    /// The rows `G`.
    border: Vec<Row<'a>>,
    schur: Cholesky<f64, Dyn>,
    cone: Option<BorderedCone>,
}

impl Newton<'_> {
    fn chains(&self, r: &mut Stages) {
        self.factors.iter().zip(r).for_each(|(factor, r)| factor.solve(r));
    }

    fn scaling(&self) -> Option<&Scaling> {
        self.cone.as_ref().map(|cone| &cone.scaling)
    }

    /// The step for a right-hand side, in its place, and that of the cone: towards its boundary, or with a centre after
    /// the predictor.
    fn solve(&self, r: &mut Stages, centre: Option<(f64, &ConeStep)>) -> Option<ConeStep> {
        let pull = self.cone.as_ref().map(|cone| cone.scaling.pull(centre));
        if let (Some(cone), Some(pull)) = (&self.cone, &pull) {
            let rows = &self.border[cone.first..];
            rows.iter().zip(triangle(pull)).for_each(|(row, pull)| row.add_to(r, pull));
        }
        let mut alone = r.clone();
        self.chains(&mut alone);
        let mut y = DVector::from_iterator(self.border.len(), self.border.iter().map(|row| row.at(&alone)));
        self.schur.solve_mut(&mut y);
        let mut step = None;
        if let (Some(cone), Some(pull)) = (&self.cone, &pull) {
            // the multiplier keeps ⟨N, Z⟩ = 1
            let own = cone.first..cone.first + cone.metric.len();
            let mut along = DVector::zeros(y.len());
            own.clone().zip(&cone.metric).for_each(|(row, metric)| along[row] = *metric);
            let metric = along.clone();
            self.schur.solve_mut(&mut along);
            let wanted = dot(&cone.metric, &triangle(pull)) - 1.0;
            let t = (metric.dot(&y) - wanted) / metric.dot(&along);
            y.axpy(-t, &along, 1.0);
            step = Some((t, y.as_slice()[own.clone()].to_vec(), own));
        }
        self.border.iter().zip(y.iter()).for_each(|(row, y)| row.add_to(r, -y));
        self.chains(r);
        // X follows the step itself and Z the multipliers y, so that rounding leaves each where its conditions want it
        let ((cone, pull), (t, y, own)) = self.cone.as_ref().zip(pull).zip(step)?;
        let rows = self.border[own].iter().zip(&cone.metric);
        let entries: Vec<f64> = rows.map(|(row, metric)| row.at(r) - metric * t).collect();
        Some(cone.scaling.step(t, &entries, &y, &pull))
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// The factor at which the first of the values vanishes.
fn furthest(values: &[f64], change: &[f64]) -> f64 {
    let each = values.iter().zip(change).filter(|(_, change)| **change < 0.0);
    each.map(|(value, change)| -value / change).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
#[path = "chain_program_tests.rs"]
mod tests;
