//! A dual bound on a conic program that holds whatever the solver did.
//!
//! Sought is the largest `cᵀy` where every entry of y is in [−1, 1] and `b − A y ∈ K`, K a product of cones.
//! For any z in the dual cone and any such y
//!
//! `cᵀy ≤ cᵀy + zᵀ(b − A y) = bᵀz + (c − Aᵀz)ᵀy ≤ bᵀz + ‖c − Aᵀz‖₁`.
//!
//! So the solver's z need not solve anything. A shift of its eigenvalues moves it into the dual cone. The
//! bound adds in full what remains of its equations, and the roundings of this computation. A solver that
//! stops early gives a looser bound, never a wrong one. Linear programs are solved by Clarabel, the moment
//! relaxations by a method of our own.
//!
//! # References
//! `jansson2008`

use crate::Interruption;
use crate::convex::{Row, conditions};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::DMatrix;
use std::ops::Range;

/// Maximise `constant + cᵀy` over `|y_j| ≤ 1`, subject to rows that are zero, rows that are not negative, and
/// positive semidefinite symmetric matrices.
#[derive(Debug, Default)]
pub(super) struct MomentProgram {
    /// Number of unknowns.
    pub(super) columns: usize,
    /// The unknowns of each clique of a chain.
    pub(super) cliques: Vec<Range<usize>>,
    /// Unknowns that cannot be negative: means of squares.
    pub(super) squares: Vec<usize>,
    /// The objective, which is maximised.
    pub(super) objective: Row,
    /// Rows that are zero.
    pub(super) zero: Vec<Row>,
    /// Rows that are not negative.
    pub(super) nonnegative: Vec<Row>,
    /// Size and upper triangle of each matrix, column by column.
    pub(super) semidefinite: Vec<(usize, Vec<Row>)>,
}

/// How long the solver may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patience<'a> {
    /// Largest number of its iterations.
    pub(super) max_iterations: u32,
    /// It stops early where this asks.
    pub(super) interruption: &'a Interruption,
}

/// A bound and how it was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DualBound {
    /// The bound.
    pub(super) value: f64,
    /// Addition for the solver's residual and for rounding; part of `value`.
    pub(super) correction: f64,
    /// Did the solver reach its solution, or nearly?
    pub(super) solved: bool,
}

/// Relative size of the roundings that are added for every product of the bound. It is some thousand times
/// the unit roundoff, since the coefficients are themselves results of a short computation.
const ROUNDING: f64 = 1e-12;

/// Share of a bound that the correction may take where the solver stopped for lack of progress.
const NEAR_ENOUGH: f64 = 0.02;

impl MomentProgram {
    /// Solves the program with this objective by Clarabel and bounds it; its rows are linear. `None` where the solver
    /// refused to start, or must not.
    pub(super) fn bound_of(&self, objective: &Row, patience: Patience<'_>) -> Option<DualBound> {
        if patience.interruption.is_asked() {
            return None;
        }
        let rows: Vec<&Row> = self.zero.iter().chain(&self.nonnegative).collect();
        let (a, b) = conditions(&rows, self.columns);
        let cones = [
            SupportedConeT::ZeroConeT(self.zero.len()),
            SupportedConeT::NonnegativeConeT(self.nonnegative.len()),
        ];
        let mut q = vec![0.0; self.columns];
        for &(column, coefficient) in &objective.terms {
            q[column] -= coefficient;
        }
        let settings = DefaultSettings {
            verbose: false,
            max_iter: patience.max_iterations,
            tol_gap_abs: 1e-6,
            tol_gap_rel: 1e-6,
            tol_feas: 1e-8,
            max_threads: 1,
            presolve_enable: false,
            ..DefaultSettings::default()
        };
        let zero = CscMatrix::zeros((self.columns, self.columns));
        let mut solver = DefaultSolver::new(&zero, &q, &a, &b, &cones, settings).ok()?;
        let interruption = patience.interruption.clone();
        solver.set_termination_callback(move |_| interruption.is_asked());
        solver.solve();
        let solution = &solver.solution;
        let ended = matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
        let mut z = solution.z.clone();
        if z.len() != b.len() || !z.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        self.project(&mut z);
        let mut bound = self.dual_value(objective, &z);
        bound.solved |= ended;
        Some(bound)
    }

    /// The bound that follows from a z in the dual cone.
    pub(super) fn dual_value(&self, objective: &Row, z: &[f64]) -> DualBound {
        let mut residual = vec![0.0; self.columns];
        for &(column, coefficient) in &objective.terms {
            residual[column] -= coefficient;
        }
        let (mut value, mut size) = (objective.constant, 0.0);
        let mut z = z.iter();
        let mut add = |row: &Row, scale: f64| {
            let Some(z) = z.next() else { return };
            let z = scale * z;
            value += row.constant * z;
            size += (row.constant * z).abs();
            for &(column, coefficient) in &row.terms {
                residual[column] -= coefficient * z;
                size += (coefficient * z).abs();
            }
        };
        self.zero.iter().chain(&self.nonnegative).for_each(|row| add(row, 1.0));
        for (size, triangle) in &self.semidefinite {
            let mut entries = triangle.iter();
            for j in 0..*size {
                for (i, row) in entries.by_ref().take(j + 1).enumerate() {
                    add(row, if i == j { 1.0 } else { std::f64::consts::SQRT_2 });
                }
            }
        }
        // what remains is −rᵀy: at most |r_j| each, and nothing where r_j and y_j are not negative
        let mut remains: Vec<f64> = residual.iter().map(|r| r.abs()).collect();
        for &column in &self.squares {
            remains[column] = (-residual[column]).max(0.0);
        }
        let correction = remains.iter().sum::<f64>() + ROUNDING * (size + value.abs());
        let solved = correction <= NEAR_ENOUGH * value.abs();
        DualBound { value: value + correction, correction, solved }
    }

    /// Moves z into the dual cone.
    pub(super) fn project(&self, z: &mut [f64]) {
        let (free, rest) = z.split_at_mut(self.zero.len());
        debug_assert_eq!(free.len(), self.zero.len());
        let (plain, mut rest) = rest.split_at_mut(self.nonnegative.len());
        plain.iter_mut().for_each(|z| *z = z.max(0.0));
        for &(size, _) in &self.semidefinite {
            let (block, after) = rest.split_at_mut(size * (size + 1) / 2);
            rest = after;
            let place = |i: usize, j: usize| j * (j + 1) / 2 + i;
            let matrix = DMatrix::from_fn(size, size, |i, j| {
                let entry = block[place(i.min(j), i.max(j))];
                if i == j { entry } else { entry / std::f64::consts::SQRT_2 }
            });
            let rounding = 100.0 * size as f64 * f64::EPSILON * matrix.norm();
            let smallest = matrix.symmetric_eigenvalues().min();
            let shift = (rounding - smallest).max(0.0);
            (0..size).for_each(|i| block[place(i, i)] += shift);
        }
    }
}
