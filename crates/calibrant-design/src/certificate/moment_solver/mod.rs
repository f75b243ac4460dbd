//! An interior-point method for the moment relaxation of a chain.
//!
//! Maximise `cᵀy` over the moments y of the cliques, with every block `X = C + Σ y_i A_i ⪰ 0` and neighbours
//! that agree, `G y = g`. With multipliers Z ⪰ 0 of the blocks and λ of the couplings, the optimum has
//!
//! `c + Aᵀ(Z) − Gᵀλ = 0`, `X = C + A(y)`, `G y = g`, `X Z = 0`.
//!
//! Each iteration takes a Newton step towards `X Z = μ I`, first with μ = 0 (Mehrotra's predictor), then with
//! a μ that the predictor's success decides. The step's equations have one block for each clique ([`chain`]),
//! and the blocks add to it through their short polynomials ([`cone`]). No iterate needs to satisfy the
//! equations: the bound that follows from Z and λ is rigorous in any case. So the method ends as soon as
//! that bound no longer improves.
//!
//! # References
//! `mehrotra1992`, `helmberg1996`

mod chain;
mod cone;

use super::dual_bound::{DualBound, MomentProgram, Patience};
use crate::convex::Row;
use chain::{ChainFactor, Coupling, Factored};
use cone::{Block, Rows};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Where X and Z begin, as multiples of the identity.
const BEGIN: (f64, f64) = (1.0, 0.01);
/// Share of the way to the boundary that a step takes.
const NEARLY: f64 = 0.9;
/// Iterations in a row that do not improve the bound, at which the method ends.
const IDLE: u32 = 3;
/// Steps below this mean that the method is stuck.
const STUCK: f64 = 1e-3;

/// A clique in the course of the iteration.
struct Clique {
    first: usize,
    objective: DVector<f64>,
    y: DVector<f64>,
    blocks: Vec<Block>,
}

/// Where each row of the program is: a block of a clique.
type Place = (usize, usize);

/// The iteration's state.
struct Iteration<'a> {
    program: &'a MomentProgram,
    cliques: Vec<Clique>,
    couplings: Vec<Coupling>,
    lambda: Vec<DVector<f64>>,
    /// The coupling and its row, of each row that is zero.
    zero: Vec<Place>,
    nonnegative: Vec<Option<Place>>,
    semidefinite: Vec<Option<Place>>,
}

/// A bound and how many iterations it took.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solved {
    pub(super) bound: DualBound,
    pub(super) iterations: u32,
    /// The moments at the end.
    #[cfg(test)]
    pub(super) moments: Vec<f64>,
}

/// Solves a program whose columns belong to the cliques of a chain, to this relative accuracy. `None` where it
/// must not.
pub(super) fn solve(program: &MomentProgram, tolerance: f64, patience: Patience<'_>) -> Option<Solved> {
    let mut iteration = Iteration::new(program);
    let mut best: Option<(f64, Vec<f64>)> = None;
    let (mut iterations, mut idle) = (0, 0);
    while iterations < patience.max_iterations && !patience.interruption.is_asked() {
        let Some(step) = iteration.advance() else { break };
        iterations += 1;
        let multipliers = iteration.multipliers();
        let bound = program.dual_value(&program.objective, &multipliers);
        let done = iteration.gap() <= tolerance * bound.value.abs()
            && bound.correction <= tolerance * bound.value.abs();
        let value = best.as_ref().map_or(f64::INFINITY, |best| best.0);
        idle = if bound.value < value - tolerance * value.abs() { 0 } else { idle + 1 };
        if bound.value < value {
            best = Some((bound.value, multipliers));
        }
        if done || step[1] < STUCK || idle == IDLE {
            break;
        }
    }
    // every Z is positive definite but for rounding, which the shift covers
    let (_, mut z) = best?;
    if !z.iter().all(|z| z.is_finite()) {
        return None;
    }
    program.project(&mut z);
    Some(Solved {
        bound: program.dual_value(&program.objective, &z),
        iterations,
        #[cfg(test)]
        moments: iteration.cliques.iter().flat_map(|clique| clique.y.iter().copied()).collect(),
    })
}

impl<'a> Iteration<'a> {
    fn new(program: &'a MomentProgram) -> Self {
        let clique_of = |row: &Row| {
            let column = row.terms.first()?.0;
            program.cliques.iter().position(|range| range.contains(&column))
        };
        let mut cliques: Vec<Clique> = program
            .cliques
            .iter()
            .map(|range| Clique {
                first: range.start,
                objective: DVector::zeros(range.len()),
                y: DVector::zeros(range.len()),
                blocks: Vec::new(),
            })
            .collect();
        for &(column, coefficient) in &program.objective.terms {
            if let Some(k) = program.cliques.iter().position(|range| range.contains(&column)) {
                cliques[k].objective[column - program.cliques[k].start] += coefficient;
            }
        }
        let mut place = |size: usize, triangle: &[Row]| -> Option<Place> {
            let k = triangle.iter().find_map(clique_of)?;
            let first = cliques[k].first;
            let local = |row: &Row| {
                (row.constant, row.terms.iter().map(|&(column, a)| (column - first, a)).collect())
            };
            let rows = Rows { size, entries: triangle.iter().map(local).collect() };
            cliques[k].blocks.push(Block::new(rows, BEGIN.0, BEGIN.1));
            Some((k, cliques[k].blocks.len() - 1))
        };
        let nonnegative = program.nonnegative.iter().map(|row| place(1, std::slice::from_ref(row))).collect();
        let semidefinite =
            program.semidefinite.iter().map(|(size, triangle)| place(*size, triangle)).collect();

        // a row that is zero couples the clique of its first column to the next one, or is of the last alone
        let count = cliques.len().saturating_sub(1);
        let mut rows: Vec<Vec<&Row>> = vec![Vec::new(); count];
        let mut zero = Vec::new();
        for row in &program.zero {
            let owner = |column: usize| program.cliques.partition_point(|range| range.end <= column);
            let k =
                row.terms.iter().map(|term| owner(term.0)).min().unwrap_or(0).min(count.saturating_sub(1));
            zero.push((k, rows[k].len()));
            rows[k].push(row);
        }
        let couplings: Vec<Coupling> = rows
            .iter()
            .enumerate()
            .map(|(k, rows)| {
                let (own, next) = (&program.cliques[k], &program.cliques[k + 1]);
                let mut coupling = Coupling {
                    before: DMatrix::zeros(rows.len(), own.len()),
                    after: DMatrix::zeros(rows.len(), next.len()),
                    constant: DVector::from_iterator(rows.len(), rows.iter().map(|row| row.constant)),
                };
                for (i, row) in rows.iter().enumerate() {
                    for &(column, a) in &row.terms {
                        if own.contains(&column) {
                            coupling.before[(i, column - own.start)] += a;
                        } else {
                            coupling.after[(i, column - next.start)] += a;
                        }
                    }
                }
                coupling
            })
            .collect();
        let lambda = couplings.iter().map(|coupling| DVector::zeros(coupling.constant.len())).collect();
        Self { program, cliques, couplings, lambda, zero, nonnegative, semidefinite }
    }

    fn gap(&self) -> f64 {
        self.cliques.iter().flat_map(|clique| &clique.blocks).map(|block| block.gap([0.0; 2])).sum()
    }

    /// The mean of the eigenvalues of `X Z`.
    fn mu(&self) -> f64 {
        let size: usize = self.cliques.iter().flat_map(|clique| &clique.blocks).map(Block::size).sum();
        self.gap() / size.max(1) as f64
    }

    /// One iteration; the lengths of its steps. `None` where rounding lets it go no further.
    fn advance(&mut self) -> Option<[f64; 2]> {
        let mu = {
            // the steps of the last iteration are part of X and Z already
            self.cliques.iter_mut().flat_map(|clique| &mut clique.blocks).for_each(Block::rest);
            self.mu()
        };
        let (before, after): (Vec<_>, Vec<_>) =
            self.couplings.iter().map(|coupling| (&coupling.before, &coupling.after)).unzip();
        let parts: Vec<(DMatrix<f64>, Factored)> = self
            .cliques
            .par_iter_mut()
            .enumerate()
            .map(|(k, clique)| {
                let mut half = DMatrix::zeros(clique.y.len(), clique.y.len());
                for block in &mut clique.blocks {
                    block.linearise(&clique.y, &mut half)?;
                }
                let h = &half + half.transpose();
                let entry = k.checked_sub(1).and_then(|k| after.get(k).copied());
                let factored = Factored::new(&h, entry, before.get(k).copied())?;
                Some((h, factored))
            })
            .collect::<Option<_>>()?;
        let (h, factored): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        let factor = ChainFactor::new(factored, &self.couplings)?;
        let rows: Vec<DVector<f64>> = self
            .couplings
            .iter()
            .enumerate()
            .map(|(k, c)| -(&c.constant + &c.before * &self.cliques[k].y + &c.after * &self.cliques[k + 1].y))
            .collect();
        let lambda = &self.lambda;
        let couplings = &self.couplings;
        let direct = |cliques: &mut [Clique], mu: f64| -> Option<Direction> {
            let right: Vec<DVector<f64>> = cliques
                .par_iter()
                .enumerate()
                .map(|(k, clique)| {
                    let mut right = &clique.objective - pulled(couplings, lambda, k, clique.y.len());
                    clique.blocks.iter().for_each(|block| block.add_right_hand_side(mu, &mut right));
                    right
                })
                .collect();
            let (mut y, mut l) = factor.solve(&right, &rows);
            // one step of iterative refinement
            let rest: Vec<DVector<f64>> = (0..cliques.len())
                .into_par_iter()
                .map(|k| &right[k] - &h[k] * &y[k] - pulled(couplings, &l, k, y[k].len()))
                .collect();
            let rest_rows: Vec<DVector<f64>> = couplings
                .iter()
                .enumerate()
                .map(|(k, c)| &rows[k] - &c.before * &y[k] - &c.after * &y[k + 1])
                .collect();
            let (dy, dl) = factor.solve(&rest, &rest_rows);
            y.iter_mut().zip(dy).for_each(|(y, dy)| *y += dy);
            l.iter_mut().zip(dl).for_each(|(l, dl)| *l += dl);
            if !y.iter().chain(&l).all(|step| step.iter().all(|x| x.is_finite())) {
                return None;
            }
            let largest = cliques
                .par_iter_mut()
                .zip(&y)
                .map(|(clique, step)| {
                    let mut steps = [1.0 / NEARLY; 2];
                    for block in &mut clique.blocks {
                        block.direct(mu, step);
                        steps = block.shorten(steps);
                    }
                    steps
                })
                .reduce(|| [1.0 / NEARLY; 2], |a, b| [a[0].min(b[0]), a[1].min(b[1])]);
            Some(Direction { y, lambda: l, largest })
        };
        let predictor = direct(&mut self.cliques, 0.0)?;
        let steps = predictor.largest.map(|step| step.min(1.0));
        let size: usize = self.cliques.iter().flat_map(|clique| &clique.blocks).map(Block::size).sum();
        let reached: f64 =
            self.cliques.iter().flat_map(|clique| &clique.blocks).map(|block| block.gap(steps)).sum::<f64>()
                / size as f64;
        let centering = (reached / mu).clamp(0.0, 1.0).powi(2).max(1e-4);
        self.cliques.par_iter_mut().for_each(|clique| clique.blocks.iter_mut().for_each(Block::correct));
        let direction = direct(&mut self.cliques, centering * mu)?;
        let steps = direction.largest.map(|step| (NEARLY * step).min(1.0));
        self.cliques.par_iter_mut().zip(&direction.y).for_each(|(clique, step)| {
            clique.y += step * steps[0];
            clique.blocks.iter_mut().for_each(|block| block.advance(steps));
        });
        self.lambda.iter_mut().zip(&direction.lambda).for_each(|(l, step)| *l += step * steps[1]);
        Some(steps)
    }

    /// Z and λ in the order of the program's rows, triangles scaled.
    fn multipliers(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.zero.iter().map(|&(k, row)| -self.lambda[k][row]).collect();
        let block = |place: &Option<Place>| place.map(|(k, block)| &self.cliques[k].blocks[block].z);
        all.extend(self.nonnegative.iter().map(|place| block(place).map_or(0.0, |z| z[0])));
        for (place, (size, _)) in self.semidefinite.iter().zip(&self.program.semidefinite) {
            for j in 0..*size {
                for i in 0..=j {
                    let scale = if i == j { 1.0 } else { std::f64::consts::SQRT_2 };
                    all.push(block(place).map_or(0.0, |z| scale * z[(i, j)]));
                }
            }
        }
        all
    }
}

/// A direction and how far it goes.
struct Direction {
    y: Vec<DVector<f64>>,
    lambda: Vec<DVector<f64>>,
    largest: [f64; 2],
}

/// `Gᵀλ` for clique k.
fn pulled(couplings: &[Coupling], lambda: &[DVector<f64>], k: usize, size: usize) -> DVector<f64> {
    let mut sum = DVector::zeros(size);
    if let Some(coupling) = couplings.get(k) {
        sum += coupling.before.tr_mul(&lambda[k]);
    }
    if let Some(before) = k.checked_sub(1) {
        sum += couplings[before].after.tr_mul(&lambda[before]);
    }
    sum
}
