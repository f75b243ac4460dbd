//! The Hessian of the Lagrangian from the last steps: damped BFGS with few pairs, in compact form (`byrd1994`).
//!
//! ```text
//! B = σ I − U M⁻¹ Uᵀ        U = (σ S, Y)        M = [ σ SᵀS   L ; Lᵀ   −D ]
//! ```
//!
//! with the steps `S`, the changes of the gradient `Y`, `SᵀY = L + D + (upper part)`, `L` strictly lower. A pair with little curvature is damped (`nocedal2006`, section 18.3):
//! `y ← θ y + (1 − θ) B s`, so that `sᵀy ≥ 0.2 sᵀB s` and `B` stays positive definite.
//!
//! Newton's system `(B + H) d = r` with the banded barrier Hessian `H` follows from the factor of `σ I + H = L Lᵀ`:
//!
//! ```text
//! d = L⁻ᵀ (y + W (M − WᵀW)⁻¹ Wᵀy)        W = L⁻¹U, y = L⁻¹r
//! ```

use super::band::{Band, dot};
use super::gram::add_squares;
use nalgebra::{DMatrix, DVector};

/// Most pairs that are kept.
const PAIRS: usize = 15;
/// Bounds of `σ`, and its value before the first step: the criteria are in nats, and the unknowns of order one.
const SIGMA: (f64, f64, f64) = (0.1, 1e4, 10.0);

/// The pairs.
#[derive(Debug, Clone)]
pub(crate) struct QuasiNewton {
    sigma: f64,
    /// Steps, changes of the gradient.
    pairs: Vec<(Vec<f64>, Vec<f64>)>,
    /// `SᵀS` and `SᵀY`.
    steps: DMatrix<f64>,
    products: DMatrix<f64>,
}

impl QuasiNewton {
    pub(crate) fn new() -> Self {
        let nothing = DMatrix::zeros(0, 0);
        Self { sigma: SIGMA.2, pairs: Vec::new(), steps: nothing.clone(), products: nothing }
    }

    pub(crate) fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Has it taken no step?
    pub(crate) fn is_new(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Number of pairs.
    fn len(&self) -> usize {
        self.pairs.len()
    }

    /// `M`.
    fn middle(&self) -> DMatrix<f64> {
        let m = self.len();
        DMatrix::from_fn(2 * m, 2 * m, |i, j| match (i < m, j < m) {
            (true, true) => self.sigma * self.steps[(i, j)],
            (true, false) if i > j - m => self.products[(i, j - m)],
            (false, true) if j > i - m => self.products[(j, i - m)],
            (false, false) if i == j => -self.products[(i - m, i - m)],
            _ => 0.0,
        })
    }

    /// `Uᵀ x`.
    fn transposed(&self, x: &[f64]) -> DVector<f64> {
        let steps = self.pairs.iter().map(|(step, _)| self.sigma * dot(step, x));
        let changes = self.pairs.iter().map(|(_, change)| dot(change, x));
        DVector::from_iterator(2 * self.len(), steps.chain(changes))
    }

    /// `B x`.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product: Vec<f64> = x.iter().map(|x| self.sigma * x).collect();
        let inner = if self.is_new() { None } else { self.middle().lu().solve(&self.transposed(x)) };
        if let Some(inner) = inner {
            let (of_steps, of_changes) = inner.as_slice().split_at(self.len());
            for (((step, change), f), g) in self.pairs.iter().zip(of_steps).zip(of_changes) {
                let f = f * self.sigma;
                for ((product, s), y) in product.iter_mut().zip(step).zip(change) {
                    *product -= f * s + g * y;
                }
            }
        }
        product
    }

    /// Takes a step and the change of the gradient along it.
    pub(crate) fn update(&mut self, step: Vec<f64>, change: &[f64]) {
        let own = self.times(&step);
        let (curved, along) = (dot(&step, &own), dot(&step, change));
        if !(curved > 0.0 && along.is_finite()) {
            return self.forget();
        }
        let theta = if along >= 0.2 * curved { 1.0 } else { 0.8 * curved / (curved - along) };
        let change: Vec<f64> = change.iter().zip(&own).map(|(y, b)| theta * y + (1.0 - theta) * b).collect();
        let (along, square) = (dot(&step, &change), dot(&step, &step));
        self.sigma = (dot(&change, &change) / along).clamp(SIGMA.0, SIGMA.1).min(3.0 * along / square);
        self.pairs.push((step, change));
        // what is known of the pairs that stay
        let dropped = usize::from(self.pairs.len() > PAIRS);
        self.pairs.drain(..dropped);
        let (m, pairs) = (self.len(), &self.pairs);
        let product = |known: &DMatrix<f64>, i: usize, j: usize, new: &dyn Fn() -> f64| {
            if i + 1 < m && j + 1 < m { known[(i + dropped, j + dropped)] } else { new() }
        };
        self.steps =
            DMatrix::from_fn(m, m, |i, j| product(&self.steps, i, j, &|| dot(&pairs[i].0, &pairs[j].0)));
        self.products =
            DMatrix::from_fn(m, m, |i, j| product(&self.products, i, j, &|| dot(&pairs[i].0, &pairs[j].1)));
    }

    /// Begins anew.
    pub(crate) fn forget(&mut self) {
        *self = Self::new();
    }

    /// Solves `(B + H) d = r`; `factor` is that of `σ I + H`. `None` if it is not regular.
    pub(crate) fn solve(&self, factor: &Band, r: &[f64]) -> Option<Vec<f64>> {
        let pairs = 2 * self.len();
        // the rows of U and r side by side
        let columns = pairs + 1;
        let mut solved = vec![0.0; r.len() * columns];
        for (i, (row, r)) in solved.chunks_exact_mut(columns).zip(r).enumerate() {
            let (of_steps, of_changes) = row.split_at_mut(self.len());
            for ((s, y), (step, change)) in of_steps.iter_mut().zip(of_changes).zip(&self.pairs) {
                (*s, *y) = (self.sigma * step[i], change[i]);
            }
            row[pairs] = *r;
        }
        factor.solve_lower(&mut solved, columns);
        let mut d: Vec<f64> = solved.iter().skip(pairs).step_by(columns).copied().collect();
        if pairs > 0 {
            let mut squares = vec![0.0; columns * columns];
            add_squares(&solved, columns, |_| 1.0, &mut squares);
            let square = |i: usize, j: usize| squares[i.max(j) * columns + i.min(j)];
            let middle = self.middle();
            let inner = DMatrix::from_fn(pairs, pairs, |i, j| middle[(i, j)] - square(i, j));
            let factors = inner.lu().solve(&DVector::from_fn(pairs, |i, _| square(pairs, i)))?;
            for (d, row) in d.iter_mut().zip(solved.chunks_exact(columns)) {
                *d += dot(&row[..pairs], factors.as_slice());
            }
        }
        factor.solve_upper(&mut d);
        d.iter().all(|d| d.is_finite()).then_some(d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;

    /// The compact form against the updates one after the other, and Newton's system against a dense solution.
    #[test]
    fn the_compact_form_is_that_of_the_updates() {
        let size = 12;
        let mut numbers = Numbers(3);
        let mut vector = || (0..size).map(|_| numbers.next(1.0)).collect::<Vec<f64>>();
        let mut of = QuasiNewton::new();
        for _ in 0..6 {
            let step = vector();
            let change: Vec<f64> = step.iter().zip(vector()).map(|(s, r)| 2.0 * s + 0.3 * r).collect();
            of.update(step, &change);
        }
        let mut dense = DMatrix::identity(size, size) * of.sigma;
        for (s, y) in &of.pairs {
            let (s, y) = (DVector::from_vec(s.clone()), DVector::from_vec(y.clone()));
            let bs = &dense * &s;
            dense += &y * y.transpose() / s.dot(&y) - &bs * bs.transpose() / s.dot(&bs);
        }
        let x = vector();
        let wanted = &dense * DVector::from_vec(x.clone());
        assert!((DVector::from_vec(of.times(&x)) - wanted).amax() < 1e-12);

        let mut band = Band::zeros(size, 3);
        for i in 0..size {
            let value = 1.0 + i as f64;
            band.add(i, i, value + of.sigma());
            dense[(i, i)] += value;
        }
        assert!(band.factor());
        let d = of.solve(&band, &x).expect("regular");
        let wanted = dense.lu().solve(&DVector::from_vec(x)).expect("regular");
        assert!((DVector::from_vec(d) - wanted).amax() < 1e-12);
    }
}
