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

use super::Block;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// An eliminated block: `L`, and `G` for the later blocks, the border and the right side.
struct Eliminated {
    factor: DMatrix<f64>,
    panel: DMatrix<f64>,
}

/// Where blocks stand in the front. They go round: block `i` has slot `i mod order`, so that nothing moves when a block is eliminated.
#[derive(Debug, Clone, Copy)]
struct Slots {
    block: usize,
    order: usize,
}

impl Slots {
    /// Number of unknowns in the slots.
    fn len(self) -> usize {
        self.block * self.order
    }

    /// First row of block `i`.
    fn first(self, i: usize) -> usize {
        i % self.order * self.block
    }

    /// The row of the `k`-th unknown counted from block `i` on; border and right side follow the slots.
    fn row(self, i: usize, k: usize) -> usize {
        if k < self.len() { self.first(i + k / self.block) + k % self.block } else { k }
    }
}

impl Slots {
    /// A matrix of slots and border, with the blocks from `i` on in their order.
    fn in_order(self, i: usize, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut ordered = DMatrix::zeros(matrix.nrows(), matrix.ncols());
        let border = matrix.nrows() - self.len();
        for (column, mut target) in ordered.column_iter_mut().enumerate() {
            let values = matrix.column(self.row(i, column));
            for r in 0..self.order {
                let from = values.rows(self.first(i + r), self.block);
                target.rows_mut(r * self.block, self.block).copy_from(&from);
            }
            target.rows_mut(self.len(), border).copy_from(&values.rows(self.len(), border));
        }
        ordered
    }
}

/// The normal equations of the blocks that are not yet complete. Its last column is the right side.
pub(crate) struct Front {
    slots: Slots,
    border: usize,
    matrix: DMatrix<f64>,
    eliminated: Vec<Eliminated>,
}

impl Front {
    /// A front of `order` blocks of `block` unknowns and a border. No blocks: `order` is 0.
    pub(crate) fn new(block: usize, order: usize, border: usize) -> Self {
        let size = block * order + border + 1;
        let slots = Slots { block, order };
        Self { slots, border, matrix: DMatrix::zeros(size, size), eliminated: Vec::new() }
    }

    /// Adds the normal equations of one interval, then eliminates its first block. The first `block · order` rows are those of its control points.
    pub(crate) fn add(&mut self, interval: &DMatrix<f64>) {
        let (i, slots) = (self.eliminated.len(), self.slots);
        if slots.order == 0 {
            self.matrix += interval;
            return;
        }
        for (column, values) in interval.column_iter().enumerate() {
            let mut target = self.matrix.column_mut(slots.row(i, column));
            for r in 0..slots.order {
                let mut block = target.rows_mut(slots.first(i + r), slots.block);
                block += values.rows(r * slots.block, slots.block);
            }
            let mut rest = target.rows_mut(slots.len(), self.border + 1);
            rest += values.rows(slots.len(), self.border + 1);
        }
        self.eliminate();
    }

    /// Adds information to the border alone.
    pub(crate) fn add_to_border(&mut self, information: &DMatrix<f64>, right: &DVector<f64>) {
        let (chain, border) = (self.slots.len(), self.border);
        let mut corner = self.matrix.view_mut((chain, chain), (border, border));
        corner += information;
        for k in 0..border {
            self.matrix[(chain + k, chain + border)] += right[k];
            self.matrix[(chain + border, chain + k)] += right[k];
        }
    }

    /// Right side and information of the border by the intervals so far, all their blocks eliminated. The increments are what each interval adds to what is
    /// known before it: independent where the residuals are.
    pub(crate) fn border(&self) -> Block {
        let (chain, border) = (self.slots.len(), self.border);
        // a slot that is empty has an infinite pivot, and tells nothing
        let factor = lower_factor(self.matrix.view((0, 0), (chain, chain)).into_owned());
        let mut above = self.matrix.view((0, chain), (chain, border + 1)).into_owned();
        factor.solve_lower_triangular_unchecked_mut(&mut above);
        let left =
            self.matrix.view((chain, chain), (border, border + 1)) - above.columns(0, border).tr_mul(&above);
        Block { score: left.column(border).into_owned(), information: left.columns(0, border).into_owned() }
    }

    fn border_right(&self) -> DVector<f64> {
        let (chain, border) = (self.slots.len(), self.border);
        self.matrix.view((chain, chain + border), (border, 1)).column(0).into_owned()
    }

    /// The information of the border, if there is no chain.
    pub(crate) fn information(&self) -> Option<DMatrix<f64>> {
        (self.slots.order == 0).then(|| self.matrix.view((0, 0), (self.border, self.border)).into_owned())
    }

    /// Eliminates the first block, and empties its slot for the next one.
    fn eliminate(&mut self) {
        let (i, slots, size) = (self.eliminated.len(), self.slots, self.matrix.nrows());
        let (first, n) = (slots.first(i), slots.block);
        let factor = lower_factor(self.matrix.view((first, first), (n, n)).into_owned());
        let mut transposed = self.matrix.rows(first, n).into_owned();
        transposed.columns_mut(first, n).fill(0.0);
        // Gᵀ = L⁻¹ Bᵀ
        factor.solve_lower_triangular_unchecked_mut(&mut transposed);
        self.matrix.gemm(-1.0, &transposed.transpose(), &transposed, 1.0);
        self.matrix.rows_mut(first, n).fill(0.0);
        self.matrix.columns_mut(first, n).fill(0.0);
        let panel = DMatrix::from_fn(size - n, n, |k, column| transposed[(column, slots.row(i, n + k))]);
        self.eliminated.push(Eliminated { factor, panel });
    }

    /// Eliminates the last blocks, and solves for everything.
    pub(crate) fn finish(mut self) -> Option<Solved> {
        for _ in 1..self.slots.order {
            self.eliminate();
        }
        let (chain, border) = (self.slots.len(), self.border);
        let information = self.matrix.view((chain, chain), (border, border)).into_owned();
        let right = self.border_right();
        let parameters = if border == 0 { right.clone() } else { Scaled::new(&information)?.solve(&right) };
        Some(Solved { slots: self.slots, information, right, parameters, eliminated: self.eliminated })
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
pub(crate) struct Solved {
    slots: Slots,
    /// Information of the parameters, the motion marginalised.
    pub(crate) information: DMatrix<f64>,
    /// Their right side.
    pub(crate) right: DVector<f64>,
    /// Their step.
    pub(crate) parameters: DVector<f64>,
    eliminated: Vec<Eliminated>,
}

impl Solved {
    /// Was a motion estimated?
    pub(crate) fn has_motion(&self) -> bool {
        !self.eliminated.is_empty()
    }

    /// The steps of all control points, for the step of the parameters in `parameters`.
    pub(crate) fn controls(&self) -> Vec<f64> {
        let Slots { block: n, order } = self.slots;
        let mut steps = vec![0.0; n * self.eliminated.len()];
        // the later blocks in the front, then the parameters, then −1 for the right side
        let later = n * order.saturating_sub(1);
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
    /// Interval `i` is that whose first block is `i`; each `every`-th is visited. `covariance` is that of the parameters.
    pub(crate) fn backwards(
        &self,
        covariance: &DMatrix<f64>,
        every: usize,
        mut visit: impl FnMut(usize, DMatrix<f64>),
    ) {
        let (slots, n, border) = (self.slots, self.slots.block, covariance.nrows());
        let size = slots.len() + border;
        // blocks beyond the end have no variance: they do not exist
        let mut window = DMatrix::zeros(size, size);
        window.view_mut((slots.len(), slots.len()), (border, border)).copy_from(covariance);
        for (i, Eliminated { factor, panel }) in self.eliminated.iter().enumerate().rev() {
            let first = slots.first(i);
            window.rows_mut(first, n).fill(0.0);
            window.columns_mut(first, n).fill(0.0);
            // x_i = −Gain x_rest + noise of covariance (L Lᵀ)⁻¹
            let mut gain = DMatrix::zeros(n, size);
            for k in 0..size - n {
                gain.column_mut(slots.row(i, n + k)).tr_copy_from(&panel.row(k));
            }
            let _ = factor.tr_solve_lower_triangular_mut(&mut gain);
            let mut own = DMatrix::identity(n, n);
            factor.solve_lower_triangular_unchecked_mut(&mut own);
            let cross = -(&gain * &window);
            let block = own.tr_mul(&own) - &cross * gain.transpose();
            window.rows_mut(first, n).copy_from(&cross);
            window.columns_mut(first, n).tr_copy_from(&cross);
            // rounding must not leave it asymmetric: the recursion would let the difference grow
            window.view_mut((first, first), (n, n)).copy_from(&((&block + block.transpose()) * 0.5));
            if i.is_multiple_of(every) {
                visit(i, slots.in_order(i, &window));
            }
        }
    }
}

/// A factored information matrix.
pub(crate) struct Scaled {
    factor: Cholesky<f64, Dyn>,
    scale: DVector<f64>,
}

impl Scaled {
    /// `None` where it is not positive definite.
    pub(crate) fn new(information: &DMatrix<f64>) -> Option<Self> {
        let scale = information.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
        let scaled = information.component_mul(&(&scale * scale.transpose()));
        Some(Self { factor: Cholesky::new(scaled)?, scale })
    }

    pub(crate) fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(&right.component_mul(&self.scale)).component_mul(&self.scale)
    }

    pub(crate) fn inverse(&self) -> DMatrix<f64> {
        self.factor.inverse().component_mul(&(&self.scale * self.scale.transpose()))
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
            solved.backwards(&covariance, 1, |i, local| {
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

    #[test]
    fn what_an_interval_adds_is_what_it_tells_beside_those_before() {
        let (intervals, order, n, border) = (6, 4, 2, 3);
        let mut front = Front::new(n, order, border);
        let size = n * (intervals + order - 1);
        let mut dense = DMatrix::zeros(size + border + 1, size + border + 1);
        for (i, part) in made_up(intervals, order, n, border, 12).iter().enumerate() {
            let equations = part * part.transpose();
            front.add(&equations);
            let to = |k: usize| if k < order * n { i * n + k } else { size + k - order * n };
            for row in 0..equations.nrows() {
                for column in 0..equations.nrows() {
                    dense[(to(row), to(column))] += equations[(row, column)];
                }
            }
            // the control points that these intervals depend on, eliminated
            let known = n * (i + order);
            let inverse = dense.view((0, 0), (known, known)).into_owned().try_inverse().expect("enough rows");
            let across = dense.view((0, size), (known, border + 1)).into_owned();
            let expected = dense.view((size, size), (border, border + 1))
                - across.columns(0, border).tr_mul(&(inverse * &across));
            let Block { score, information } = front.border();
            assert!((score - expected.column(border)).amax() < 1e-9 * expected.amax(), "{i}");
            assert!((information - expected.columns(0, border)).amax() < 1e-9 * expected.amax(), "{i}");
        }
    }
}
