//! The quadratic program of one axis without inequalities, solved by the recursion of Riccati.
//!
//! An axis is a chain: its state `(a, v, d)` at a node and its control `(u, s)` in the interval behind it give
//! the next state, `x' = A x + B u`. Here u is the increment of the acceleration, and s a variable of the interval
//! alone. The program is `minimise Σ ½ zᵀ W z − r·z`, `z = (a, v, d, u, s)`, W of each stage positive
//! semidefinite.
//!
//! The cost of the rest of the chain is `½ xᵀ P x + p·x`. With `W = [[W_x, W_xu], [W_ux, W_u]]`,
//!
//! - `M = W_u + Bᵀ P' B`, `K = −M⁻¹ (W_ux + Bᵀ P' A)`
//! - `P = W_x + Aᵀ P' A − Kᵀ M K`
//! - `q = Bᵀ p' − r_u`, `p = Aᵀ p' − r_x + Kᵀ q`, and forwards `u = K x − M⁻¹ q`.
//!
//! So the factorisation takes O(N), and again each right-hand side.
//!
//! # References
//! `rao1998`

use nalgebra::{Matrix2, Matrix2x3, Matrix3, SMatrix, SVector, Vector3};

/// State and control of one stage: `(a, v, d, u, s)`.
pub(crate) type Stage = SVector<f64, 5>;
/// Weight of one stage.
pub(crate) type StageWeight = SMatrix<f64, 5, 5>;

/// How an interval of duration h takes the state to the next node: `a + u`, `v + h (a + u/2)`,
/// `d + h v + h² (a/2 + u/6)`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transition(pub(crate) f64);

impl Transition {
    /// The state after a stage.
    #[inline]
    pub(crate) fn next(self, z: &Stage) -> Vector3<f64> {
        let h = self.0;
        let (a, v, d, u) = (z[0], z[1], z[2], z[3]);
        Vector3::new(a + u, v + h * (a + u / 2.0), d + h * (v + h * (a / 2.0 + u / 6.0)))
    }

    /// `Aᵀ p`, and `Bᵀ p` for u; that for s is zero.
    #[inline]
    fn pulled(self, p: Vector3<f64>) -> (Vector3<f64>, f64) {
        let h = self.0;
        let state = Vector3::new(p[0] + h * (p[1] + h / 2.0 * p[2]), p[1] + h * p[2], p[2]);
        (state, p[0] + h * (p[1] / 2.0 + h / 6.0 * p[2]))
    }

    /// `[A B]ᵀ P [A B]`: the blocks of state and state, u and state, u and u.
    #[inline]
    fn pulled_back(self, p: &Matrix3<f64>) -> (Matrix3<f64>, Vector3<f64>, f64) {
        let half: [(Vector3<f64>, f64); 3] = std::array::from_fn(|k| self.pulled(p.column(k).into()));
        // rows of [A B]ᵀ P are pulled in turn
        let rows: [(Vector3<f64>, f64); 3] =
            std::array::from_fn(|k| self.pulled(Vector3::new(half[0].0[k], half[1].0[k], half[2].0[k])));
        let (mixed, own) = self.pulled(Vector3::new(half[0].1, half[1].1, half[2].1));
        let state = Matrix3::from_fn(|i, j| rows[i.max(j)].0[i.min(j)]);
        (state, mixed, own)
    }
}

/// The factorisation.
pub(crate) struct ChainFactor<'a> {
    transitions: &'a [Transition],
    gains: Vec<Matrix2x3<f64>>,
    /// `M⁻¹`.
    inverses: Vec<Matrix2<f64>>,
    /// Inverse of P's entry of the first acceleration; 0 where that is fixed.
    first: f64,
}

impl<'a> ChainFactor<'a> {
    /// Factors the weights of the stages, one more than there are transitions; the last has no control. The chain
    /// begins at rest; its first acceleration is free or fixed. `None` where a pivot is not positive.
    pub(crate) fn new(transitions: &'a [Transition], weights: &[StageWeight], free: bool) -> Option<Self> {
        let n = transitions.len();
        let mut gains = vec![Matrix2x3::zeros(); n];
        let mut inverses = vec![Matrix2::zeros(); n];
        let mut p: Matrix3<f64> = weights[n].fixed_view::<3, 3>(0, 0).into_owned();
        for (i, transition) in transitions.iter().enumerate().rev() {
            let w = &weights[i];
            let (state, mixed, own) = transition.pulled_back(&p);
            let mut m: Matrix2<f64> = w.fixed_view::<2, 2>(3, 3).into_owned();
            m[(0, 0)] += own;
            let mut both: Matrix2x3<f64> = w.fixed_view::<2, 3>(3, 0).into_owned();
            (0..3).for_each(|k| both[(0, k)] += mixed[k]);
            let inverse = inverse(&m)?;
            let gain = -(inverse * both);
            p = Matrix3::from_fn(|i, j| {
                let (i, j) = (i.max(j), i.min(j));
                w[(i, j)] + state[(i, j)] + both[(0, i)] * gain[(0, j)] + both[(1, i)] * gain[(1, j)]
            });
            gains[i] = gain;
            inverses[i] = inverse;
        }
        let first = match (free, p[(0, 0)]) {
            (false, _) => 0.0,
            (true, pivot) if pivot > 0.0 => 1.0 / pivot,
            _ => return None,
        };
        Some(Self { transitions, gains, inverses, first })
    }

    /// The minimum for a right-hand side, in its place.
    pub(crate) fn solve(&self, r: &mut [Stage]) {
        let n = self.transitions.len();
        let mut p: Vector3<f64> = -r[n].fixed_rows::<3>(0);
        for i in (0..n).rev() {
            let (state, own) = self.transitions[i].pulled(p);
            let (z, gain, m) = (&mut r[i], &self.gains[i], &self.inverses[i]);
            let q = [own - z[3], -z[4]];
            p = Vector3::from_fn(|k, _| state[k] - z[k] + gain[(0, k)] * q[0] + gain[(1, k)] * q[1]);
            z[3] = -(m[(0, 0)] * q[0] + m[(0, 1)] * q[1]);
            z[4] = -(m[(1, 0)] * q[0] + m[(1, 1)] * q[1]);
        }
        let mut x = Vector3::new(-p[0] * self.first, 0.0, 0.0);
        for (i, transition) in self.transitions.iter().enumerate() {
            let (z, gain) = (&mut r[i], &self.gains[i]);
            let u = |k: usize| z[3 + k] + gain[(k, 0)] * x[0] + gain[(k, 1)] * x[1] + gain[(k, 2)] * x[2];
            *z = Stage::new(x[0], x[1], x[2], u(0), u(1));
            x = transition.next(&r[i]);
        }
        r[n] = Stage::new(x[0], x[1], x[2], 0.0, 0.0);
    }
}

/// The inverse of a symmetric matrix, if it is positive definite.
fn inverse(m: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let (a, b, c) = (m[(0, 0)], m[(0, 1)], m[(1, 1)]);
    let pivot = a - b * b / c;
    let positive = c > 0.0 && pivot > 0.0 && pivot.is_finite();
    positive.then(|| {
        let off = -b / (c * pivot);
        Matrix2::new(1.0 / pivot, off, off, 1.0 / c + b * b / (c * c * pivot))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// The stages as linear functions of the free variables: the first acceleration, then u and s of every interval.
    fn stages(transitions: &[Transition], free: usize) -> Vec<DMatrix<f64>> {
        let n = transitions.len();
        let mut all = vec![DMatrix::zeros(5, 1 + 2 * n); n + 1];
        for column in 1 - free..=2 * n {
            let mut x = Vector3::new(f64::from(u8::from(column == 0)), 0.0, 0.0);
            for i in 0..=n {
                let control = |k: usize| f64::from(u8::from(i < n && column == 1 + 2 * i + k));
                let z = Stage::new(x[0], x[1], x[2], control(0), control(1));
                all[i].set_column(column, &z);
                if i < n {
                    x = transitions[i].next(&z);
                }
            }
        }
        all
    }

    #[test]
    fn the_recursion_solves_the_dense_program() {
        let transitions: Vec<_> = (0..7).map(|i| Transition(1.0 + 0.1 * f64::from(i))).collect();
        let wave = |i: usize, j: usize, k: usize| ((3 * i + 5 * j + 7 * k + i * j * k) as f64).sin();
        let weights: Vec<StageWeight> = (0..8)
            .map(|i| {
                let root = StageWeight::from_fn(|j, k| wave(i, j, k));
                root * root.transpose()
            })
            .collect();
        let r: Vec<Stage> = (0..8)
            .map(|i| Stage::from_fn(|j, _| if i == 7 && j > 2 { 0.0 } else { wave(i, j, 2) }))
            .collect();
        for free in [true, false] {
            let mut x = r.clone();
            ChainFactor::new(&transitions, &weights, free).expect("positive").solve(&mut x);
            let stages = stages(&transitions, usize::from(free));
            let (mut h, mut g) = (DMatrix::zeros(15, 15), DVector::zeros(15));
            for ((z, w), r) in stages.iter().zip(&weights).zip(&r) {
                h += z.tr_mul(&(w * z));
                g += z.tr_mul(r);
            }
            if !free {
                h[(0, 0)] = 1.0;
            }
            let dense = h.cholesky().expect("positive").solve(&g);
            for (z, x) in stages.iter().zip(&x) {
                assert!((z * &dense - x).amax() < 1e-10 * dense.amax(), "{x}");
            }
        }
    }

    #[test]
    fn a_chain_without_weight_has_no_minimum() {
        let transitions = [Transition(1.0)];
        assert!(ChainFactor::new(&transitions, &[StageWeight::zeros(); 2], true).is_none());
    }
}
