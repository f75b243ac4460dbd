//! Eliminates a chain of control points with a border of parameters: the arrowhead of the estimator, block by block.
//!
//! Each interval of a spline couples `order` consecutive blocks of control points, and all parameters. The front holds the normal equations
//! of these blocks and of the border. When an interval is added, its first block is complete, and is eliminated:
//!
//! ```text
//! [A Bᵀ]   L Lᵀ = A,  G = B L⁻ᵀ,   C ← C − G Gᵀ
//! [B C ]
//! ```
//!
//! Blocks of joints have one entry a joint, those of poses six. What is left at the end is the information of the parameters, with the motion marginalised.
//! Time and memory are linear in the number of intervals. Without blocks (`Trust::Known`) the front is the border alone.

use super::scaled::Scaled;
use nalgebra::{DMatrix, DVector};

/// An eliminated block: `L`, and `G` for the later blocks, the border and the right side.
struct Eliminated {
    factor: DMatrix<f64>,
    panel: DMatrix<f64>,
}

/// The normal equations of the blocks that are not yet complete. Its last column is the right side.
pub(super) struct Front {
    block: usize,
    order: usize,
    border: usize,
    matrix: DMatrix<f64>,
    eliminated: Vec<Eliminated>,
}

impl Front {
    /// A front of `order` blocks of `block` unknowns and a border. No blocks: `order` is 0.
    pub(super) fn new(block: usize, order: usize, border: usize) -> Self {
        let size = block * order + border + 1;
        Self { block, order, border, matrix: DMatrix::zeros(size, size), eliminated: Vec::new() }
    }

    /// Number of unknowns of the blocks in the front.
    fn chain(&self) -> usize {
        self.block * self.order
    }

    /// Adds the normal equations of one interval, then eliminates its first block. The first `block · order` rows are those of its control points.
    pub(super) fn add(&mut self, interval: &DMatrix<f64>) {
        self.matrix += interval;
        if self.chain() > 0 {
            self.eliminate();
        }
    }

    /// Adds information to the border alone.
    pub(super) fn add_to_border(&mut self, information: &DMatrix<f64>, right: &DVector<f64>) {
        let (chain, border) = (self.chain(), self.border);
        let mut corner = self.matrix.view_mut((chain, chain), (border, border));
        corner += information;
        for k in 0..border {
            self.matrix[(chain + k, chain + border)] += right[k];
            self.matrix[(chain + border, chain + k)] += right[k];
        }
    }

    /// The right side of the border as it stands: its increments are the scores of the intervals.
    pub(super) fn border_right(&self) -> DVector<f64> {
        let (chain, border) = (self.chain(), self.border);
        self.matrix.view((chain, chain + border), (border, 1)).column(0).into_owned()
    }

    /// The information of the border, if there is no chain.
    pub(super) fn information(&self) -> Option<DMatrix<f64>> {
        (self.order == 0).then(|| self.matrix.view((0, 0), (self.border, self.border)).into_owned())
    }

    fn eliminate(&mut self) {
        let (n, size) = (self.block, self.matrix.nrows());
        let factor = lower_factor(self.matrix.view((0, 0), (n, n)).into_owned());
        // Gᵀ = L⁻¹ Bᵀ
        let mut transposed = self.matrix.view((0, n), (n, size - n)).into_owned();
        factor.solve_lower_triangular_unchecked_mut(&mut transposed);
        let panel = transposed.transpose();
        let mut rest = self.matrix.view((n, n), (size - n, size - n)).into_owned();
        rest.gemm(-1.0, &panel, &transposed, 1.0);
        self.shift(&rest);
        self.eliminated.push(Eliminated { factor, panel });
    }

    /// Moves what is left one block up, and makes room for the next block before the border.
    fn shift(&mut self, rest: &DMatrix<f64>) {
        let (n, chain, size) = (self.block, self.chain(), self.matrix.nrows());
        let later = chain - n;
        self.matrix.fill(0.0);
        let to = |k: usize| if k < later { k } else { k + n };
        for column in 0..size - n {
            let target = to(column);
            let (blocks, border) =
                (rest.view((0, column), (later, 1)), rest.view((later, column), (size - n - later, 1)));
            self.matrix.view_mut((0, target), (later, 1)).copy_from(&blocks);
            self.matrix.view_mut((chain, target), (size - chain, 1)).copy_from(&border);
        }
    }

    /// Eliminates the last blocks, and solves for everything.
    pub(super) fn finish(mut self) -> Option<Solved> {
        for _ in 1..self.order {
            self.eliminate();
        }
        let (chain, border) = (self.chain(), self.border);
        let information = self.matrix.view((chain, chain), (border, border)).into_owned();
        let right = self.border_right();
        let parameters = if border == 0 { right.clone() } else { Scaled::new(&information)?.solve(&right) };
        Some(Solved {
            block: self.block,
            order: self.order,
            information,
            right,
            parameters,
            eliminated: self.eliminated,
        })
    }
}

/// The factor `L` of a positive definite matrix. A pivot that vanishes by rounding becomes one that holds its unknown where it is.
fn lower_factor(mut a: DMatrix<f64>) -> DMatrix<f64> {
    /// Largest loss of digits that leaves a pivot.
    const ROUNDING: f64 = 1e-13;
    for j in 0..a.nrows() {
        let before = a[(j, j)];
        for i in j..a.nrows() {
            let sum: f64 = (0..j).map(|k| a[(i, k)] * a[(j, k)]).sum();
            a[(i, j)] -= sum;
        }
        let pivot = if a[(j, j)] > ROUNDING * before { a[(j, j)].sqrt() } else { f64::INFINITY };
        a[(j, j)] = pivot;
        for i in j + 1..a.nrows() {
            a[(i, j)] /= pivot;
            a[(j, i)] = 0.0;
        }
    }
    a
}

/// The solved equations.
pub(super) struct Solved {
    block: usize,
    order: usize,
    /// Information of the parameters, the motion marginalised.
    pub(super) information: DMatrix<f64>,
    /// Their right side.
    pub(super) right: DVector<f64>,
    /// Their step.
    pub(super) parameters: DVector<f64>,
    eliminated: Vec<Eliminated>,
}

impl Solved {
    /// Was a motion estimated?
    pub(super) fn has_motion(&self) -> bool {
        !self.eliminated.is_empty()
    }

    /// The steps of all control points, for the step of the parameters in `parameters`.
    pub(super) fn controls(&self) -> Vec<f64> {
        let n = self.block;
        let mut steps = vec![0.0; n * self.eliminated.len()];
        // the later blocks in the front, then the parameters, then −1 for the right side
        let later = n * self.order.saturating_sub(1);
        let border = self.parameters.len();
        let mut known = DVector::zeros(later + border + 1);
        known.rows_mut(later, border).copy_from(&self.parameters);
        known[later + border] = -1.0;
        for (i, eliminated) in self.eliminated.iter().enumerate().rev() {
            let mut step = -eliminated.panel.tr_mul(&known);
            let _ = eliminated.factor.tr_solve_lower_triangular_mut(&mut step);
            steps[i * n..(i + 1) * n].copy_from_slice(step.as_slice());
            for k in (n..later).rev() {
                known[k] = known[k - n];
            }
            let first = n.min(later);
            known.rows_mut(0, first).copy_from(&step.rows(0, first));
        }
        steps
    }

    /// Goes back through the intervals with the covariance of each interval's control points and the parameters, block·order + border square.
    /// Interval `i` is that whose first block is `i`. `covariance` is that of the parameters.
    pub(super) fn backwards(&self, covariance: &DMatrix<f64>, mut visit: impl FnMut(usize, &DMatrix<f64>)) {
        let (n, border) = (self.block, covariance.nrows());
        let later = n * self.order.saturating_sub(1);
        let mut window = DMatrix::zeros(later + n + border, later + n + border);
        // blocks beyond the end have no variance: they do not exist
        window.view_mut((later + n, later + n), (border, border)).copy_from(covariance);
        for (i, Eliminated { factor, panel }) in self.eliminated.iter().enumerate().rev() {
            let mut rest = DMatrix::zeros(later + border, later + border);
            let from = |k: usize| if k < later { k } else { k + n };
            for column in 0..later + border {
                for row in 0..later + border {
                    rest[(row, column)] = window[(from(row), from(column))];
                }
            }
            // x_i = −Gain x_rest + noise of covariance (L Lᵀ)⁻¹
            let mut gain = panel.rows(0, later + border).transpose();
            let _ = factor.tr_solve_lower_triangular_mut(&mut gain);
            let mut own = DMatrix::identity(n, n);
            factor.solve_lower_triangular_unchecked_mut(&mut own);
            let own = own.tr_mul(&own);
            let cross = -(&gain * &rest);
            let block = own - &cross * gain.transpose();
            // rounding must not leave it asymmetric: the recursion would let the difference grow
            let block = (&block + block.transpose()) * 0.5;
            window.view_mut((0, 0), (n, n)).copy_from(&block);
            for column in 0..later + border {
                for row in 0..later + border {
                    window[(n + row, n + column)] = rest[(row, column)];
                }
                for row in 0..n {
                    window[(row, n + column)] = cross[(row, column)];
                    window[(n + column, row)] = cross[(row, column)];
                }
            }
            visit(i, &window);
            // the last block leaves: `from` skips it in the next round, where the first becomes one of the later
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a chain of `intervals` with `order` blocks of `n` each, and a border.
    fn made_up(intervals: usize, order: usize, n: usize, border: usize, rows: usize) -> Vec<DMatrix<f64>> {
        let mut state = 7_u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        (0..intervals).map(|_| DMatrix::from_fn(order * n + border + 1, rows, |_, _| next())).collect()
    }

    #[test]
    fn it_equals_dense_algebra() {
        for (intervals, order, n, border, rows) in [(7, 4, 2, 3, 9), (5, 6, 1, 2, 4), (9, 4, 6, 5, 30)] {
            let parts = made_up(intervals, order, n, border, rows);
            let mut front = Front::new(n, order, border);
            let chain = n * (intervals + order - 1);
            let size = chain + border;
            let mut dense = DMatrix::zeros(size + 1, size + 1);
            for (i, part) in parts.iter().enumerate() {
                let equations = part * part.transpose();
                front.add(&equations);
                let to = |k: usize| if k < order * n { i * n + k } else { chain + k - order * n };
                for row in 0..equations.nrows() {
                    for column in 0..equations.nrows() {
                        dense[(to(row), to(column))] += equations[(row, column)];
                    }
                }
            }
            let inverse = dense.view((0, 0), (size, size)).into_owned().try_inverse().expect("enough rows");
            let expected = &inverse * dense.view((0, size), (size, 1));
            let solved = front.finish().expect("enough rows");
            assert!((&solved.parameters - expected.rows(chain, border)).norm() < 1e-9 * expected.norm());
            let controls = DVector::from_vec(solved.controls());
            assert!((controls - expected.rows(0, chain)).norm() < 1e-9 * expected.norm());
            let covariance = solved.information.clone().try_inverse().expect("positive");
            let mut visited = 0;
            solved.backwards(&covariance, |i, local| {
                visited += 1;
                let of = |k: usize| if k < order * n { i * n + k } else { chain + k - order * n };
                for row in 0..local.nrows() {
                    for column in 0..local.nrows() {
                        // beyond the end there is no block
                        if [row, column].iter().all(|k| *k >= order * n || of(*k) < chain) {
                            let error = local[(row, column)] - inverse[(of(row), of(column))];
                            assert!(error.abs() < 1e-9 * inverse.amax(), "{i} {row} {column}: {error}");
                        }
                    }
                }
            });
            assert_eq!(visited, intervals + order - 1);
        }
    }
}
