//! The pointwise limits at all times of a grid, as rows of an optimisation problem in the unknowns.

use super::band::Band;
use crate::limits::{PointRows, PointWork, Pointwise};
use crate::motion::{Grid, Knots, Ties, derivative};
use nalgebra::DMatrix;

/// Rows, and their derivatives where they were asked for last.
pub(crate) struct Rows<'a> {
    pointwise: Pointwise<'a>,
    grid: Grid,
    work: PointWork,
    n: usize,
    /// Rows at one time: of positions alone, and of the state of the joints.
    positions: usize,
    states: usize,
    /// One value for each time and row.
    pub(crate) values: Vec<f64>,
    by_position: Vec<f64>,
    by_state: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// At this number of times in each interval.
    pub(crate) fn new(pointwise: Pointwise<'a>, knots: Knots, times: usize) -> Self {
        let grid = Grid::even(knots, times);
        let n = pointwise.problem.chain.joints.len();
        let positions = pointwise.position_rows();
        let states = pointwise.rows() - positions;
        let work = pointwise.work();
        Self {
            n,
            positions,
            states,
            values: vec![1.0; grid.len() * (positions + states)],
            by_position: vec![0.0; grid.len() * positions * n],
            by_state: vec![0.0; grid.len() * states * 3 * n],
            pointwise,
            grid,
            work,
        }
    }

    /// Values, with derivatives where they are wanted. Gives the least value.
    pub(crate) fn evaluate(&mut self, controls: &DMatrix<f64>, with_slopes: bool) -> f64 {
        let (rows, n) = (self.positions + self.states, self.n);
        for k in 0..self.grid.len() {
            let at = PointRows {
                values: &mut self.values[k * rows..(k + 1) * rows],
                by_position: &mut self.by_position[k * self.positions * n..(k + 1) * self.positions * n],
                by_state: &mut self.by_state[k * self.states * 3 * n..(k + 1) * self.states * 3 * n],
                with_slopes,
            };
            self.pointwise.at(&mut self.work, &self.grid, k, controls, at);
        }
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The derivatives of row `row` at time `k`, by positions, velocities, accelerations as far as it has them.
    fn slopes(&self, k: usize, row: usize) -> &[f64] {
        let n = self.n;
        match row.checked_sub(self.positions) {
            None => &self.by_position[(k * self.positions + row) * n..][..n],
            Some(row) => &self.by_state[(k * self.states + row) * 3 * n..][..3 * n],
        }
    }

    /// Adds `Σ multiplier · ∂row/∂controls`.
    pub(crate) fn add_transposed(&self, multipliers: &[f64], out: &mut DMatrix<f64>) {
        let (rows, n) = (self.positions + self.states, self.n);
        let mut sum = vec![0.0; 3 * n];
        for (k, multipliers) in multipliers.chunks_exact(rows.max(1)).enumerate() {
            sum.fill(0.0);
            for (row, multiplier) in multipliers.iter().enumerate() {
                for (sum, slope) in sum.iter_mut().zip(self.slopes(k, row)) {
                    *sum += multiplier * slope;
                }
            }
            let (i, weights) = self.grid.rows(k);
            for j in 0..n {
                let mut column = out.column_mut(j);
                for r in 0..4 {
                    column[i + r] +=
                        weights[0][r] * sum[j] + weights[1][r] * sum[n + j] + weights[2][r] * sum[2 * n + j];
                }
            }
        }
    }

    /// How the rows change along a direction of the control points.
    pub(crate) fn changes(&self, direction: &DMatrix<f64>, changes: &mut [f64]) {
        let (rows, n) = (self.positions + self.states, self.n);
        let mut state = vec![0.0; 3 * n];
        for (k, changes) in changes.chunks_exact_mut(rows.max(1)).enumerate() {
            let (i, weights) = self.grid.rows(k);
            for d in 0..3 {
                for j in 0..n {
                    state[d * n + j] = derivative(direction, i, &weights[d], j);
                }
            }
            for (row, change) in changes.iter_mut().enumerate() {
                *change = self.slopes(k, row).iter().zip(&state).map(|(slope, state)| slope * state).sum();
            }
        }
    }

    /// Adds `Σ weight · ∂row ∂rowᵀ` in the unknowns.
    pub(crate) fn add_squares(&self, weights: &[f64], ties: &Ties, band: &mut Band) {
        let (rows, n) = (self.positions + self.states, self.n);
        let size = 3 * n;
        // by positions, velocities, accelerations: the lower triangle
        let mut square = vec![0.0; size * size];
        let mut mixed = vec![0.0; size * n];
        let mut line = vec![0.0; n];
        for (k, weights) in weights.chunks_exact(rows.max(1)).enumerate() {
            square.fill(0.0);
            for (row, weight) in weights.iter().enumerate() {
                let slopes = self.slopes(k, row);
                for (a, slope) in slopes.iter().enumerate() {
                    let factor = weight * slope;
                    if factor != 0.0 {
                        for (sum, slope) in square[a * size..=a * size + a].iter_mut().zip(slopes) {
                            *sum += factor * slope;
                        }
                    }
                }
            }
            for a in 0..size {
                for b in 0..a {
                    square[b * size + a] = square[a * size + b];
                }
            }
            // the unknowns of the interval, and how the state depends on them
            let (i, of) = self.grid.rows(k);
            let mut unknowns: [(usize, [f64; 3]); 4] = [(usize::MAX, [0.0; 3]); 4];
            let mut count = 0;
            for r in 0..4 {
                let Some(unknown) = ties.of(i + r) else { continue };
                if count == 0 || unknowns[count - 1].0 != unknown {
                    unknowns[count] = (unknown, [0.0; 3]);
                    count += 1;
                }
                for (sum, of) in unknowns[count - 1].1.iter_mut().zip(of) {
                    *sum += of[r];
                }
            }
            for (place, (one, by_one)) in unknowns[..count].iter().enumerate() {
                for (row, mixed) in mixed.chunks_exact_mut(n).enumerate() {
                    for (j, mixed) in mixed.iter_mut().enumerate() {
                        let of = |d: usize| by_one[d] * square[row * size + d * n + j];
                        *mixed = of(0) + of(1) + of(2);
                    }
                }
                // rows are those of the later unknown
                for (other, by_other) in &unknowns[place..count] {
                    for a in 0..n {
                        let length = if other == one { a + 1 } else { n };
                        for (b, line) in line.iter_mut().enumerate().take(length) {
                            let of = |d: usize| by_other[d] * mixed[(d * n + a) * n + b];
                            *line = ties.size(a) * ties.size(b) * (of(0) + of(1) + of(2));
                        }
                        band.add_row(other * n + a, one * n, &line[..length]);
                    }
                }
            }
        }
    }
}
