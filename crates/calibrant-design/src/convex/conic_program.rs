//! A convex program in this crate's terms, which Clarabel solves. But for the linear programs of the certificate, no
//! other file knows Clarabel's form.
//!
//! `minimise ½ xᵀ P x + qᵀ x` subject to conditions on rows `row(x) = constant + Σ terms · x`. A row is zero,
//! not negative, or in a second-order cone.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// An affine form of the variables.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Row {
    /// Coefficients by variable; a variable may occur more than once.
    pub(crate) terms: Vec<(usize, f64)>,
    /// The constant term.
    pub(crate) constant: f64,
}

impl Row {
    pub(crate) fn new(constant: f64, terms: impl IntoIterator<Item = (usize, f64)>) -> Self {
        Self { terms: terms.into_iter().collect(), constant }
    }

    /// `factor · self`.
    pub(crate) fn times(mut self, factor: f64) -> Self {
        self.constant *= factor;
        self.terms.iter_mut().for_each(|(_, value)| *value *= factor);
        self
    }

    /// `self + other`.
    pub(crate) fn plus(mut self, other: &Self) -> Self {
        self.constant += other.constant;
        self.terms.extend_from_slice(&other.terms);
        self
    }
}

/// `A` and `b` of `A x + s = b`, where s are these rows.
pub(crate) fn conditions(rows: &[&Row], variables: usize) -> (CscMatrix<f64>, Vec<f64>) {
    let (mut i, mut j, mut v) = (Vec::new(), Vec::new(), Vec::new());
    for (number, row) in rows.iter().enumerate() {
        for &(variable, value) in &row.terms {
            i.push(number);
            j.push(variable);
            v.push(-value);
        }
    }
    let a = CscMatrix::new_from_triplets(rows.len(), variables, i, j, v);
    (a, rows.iter().map(|row| row.constant).collect())
}

/// The program.
#[derive(Debug, Clone, Default)]
pub(crate) struct ConicProgram {
    variables: usize,
    /// Diagonal of `P`, by variable.
    quadratic: Vec<(usize, f64)>,
    linear: Vec<(usize, f64)>,
    zero: Vec<Row>,
    nonnegative: Vec<Row>,
    second_order: Vec<[Row; 3]>,
}

/// Its solution.
#[derive(Debug, Clone)]
pub(crate) struct ConicSolution {
    pub(crate) x: Vec<f64>,
    /// Multipliers of the rows that may not be negative, in the order in which they were added.
    pub(crate) multipliers: Vec<f64>,
}

impl ConicProgram {
    /// Adds variables; returns the place of the first.
    pub(crate) fn add_variables(&mut self, count: usize) -> usize {
        self.variables += count;
        self.variables - count
    }

    /// Adds `½ weight x²` to the objective.
    pub(crate) fn add_square(&mut self, variable: usize, weight: f64) {
        self.quadratic.push((variable, weight));
    }

    /// Adds `weight x` to the objective.
    pub(crate) fn add_linear(&mut self, variable: usize, weight: f64) {
        self.linear.push((variable, weight));
    }

    /// `row = 0`.
    pub(crate) fn zero(&mut self, row: Row) {
        self.zero.push(row);
    }

    /// `row ≥ 0`; returns its number.
    pub(crate) fn nonnegative(&mut self, row: Row) -> usize {
        self.nonnegative.push(row);
        self.nonnegative.len() - 1
    }

    /// `|row| ≤ limit`.
    pub(crate) fn within(&mut self, row: &Row, limit: f64) {
        let bound = Row::new(1.0, []);
        let part = row.clone().times(1.0 / limit);
        self.nonnegative(bound.clone().plus(&part.clone().times(-1.0)));
        self.nonnegative(bound.plus(&part));
    }

    /// `[[a, b], [b, c]] ⪰ 0`: as a second-order cone, `a + c ≥ ‖(a − c, 2b)‖`.
    pub(crate) fn semidefinite_2(&mut self, a: Row, b: Row, c: Row) {
        let sum = a.clone().plus(&c);
        let difference = a.plus(&c.times(-1.0));
        self.second_order.push([sum, difference, b.times(2.0)]);
    }

    /// Solves it; `None` where Clarabel finds no solution, or not even an approximate one.
    pub(crate) fn solve(&self) -> Option<ConicSolution> {
        let n = self.variables;
        let mut cones = Vec::new();
        let mut rows: Vec<&Row> = Vec::new();
        if !self.zero.is_empty() {
            cones.push(SupportedConeT::ZeroConeT(self.zero.len()));
            rows.extend(&self.zero);
        }
        let first = rows.len();
        if !self.nonnegative.is_empty() {
            cones.push(SupportedConeT::NonnegativeConeT(self.nonnegative.len()));
            rows.extend(&self.nonnegative);
        }
        for cone in &self.second_order {
            cones.push(SupportedConeT::SecondOrderConeT(3));
            rows.extend(cone);
        }
        let (a, b) = conditions(&rows, n);
        let (at, weights): (Vec<_>, Vec<_>) = self.quadratic.iter().copied().unzip();
        let p = CscMatrix::new_from_triplets(n, n, at.clone(), at, weights);
        let mut q = vec![0.0; n];
        for &(variable, weight) in &self.linear {
            q[variable] += weight;
        }
        let settings = DefaultSettings {
            verbose: false,
            max_iter: 100,
            tol_gap_abs: 1e-10,
            tol_gap_rel: 1e-10,
            tol_feas: 1e-10,
            presolve_enable: false,
            max_threads: 1,
            direct_solve_method: "qdldl".into(),
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, &q, &a, &b, &cones, settings).ok()?;
        solver.solve();
        let usable = matches!(
            solver.solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        if !usable || solver.solution.x.iter().any(|x| !x.is_finite()) {
            return None;
        }
        Some(ConicSolution {
            x: solver.solution.x.clone(),
            multipliers: solver.solution.z[first..first + self.nonnegative.len()].to_vec(),
        })
    }
}
