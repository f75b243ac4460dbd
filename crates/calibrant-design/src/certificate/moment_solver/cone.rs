//! One positive semidefinite block `X = C + Σ y_i A_i ⪰ 0` of a clique, and its multiplier Z.
//!
//! The direction is that of Helmberg, Rendl, Vanderbei and Wolkowicz (HKM). From `Z = μ X⁻¹`, with `sym M = (M + Mᵀ)/2`,
//!
//! `ΔZ = μ X⁻¹ − Z − sym(X⁻¹ ΔX Z) − sym(X⁻¹ ΔX_p ΔZ_p)`, `ΔX = Σ Δy_i A_i + R`,
//!
//! with `R = C + Σ y_i A_i − X` what is missing of the equation and the last term Mehrotra's correction from
//! the predictor. In the equation of the moments it adds `H_ij = tr(A_i X⁻¹ A_j Z)`. Every entry of a block is a
//! short polynomial, a row of coefficients. So H is `AᵀKA` with A the rows of the upper triangle and
//!
//! `K_(pq)(rs) = P_qr Z_sp + P_pr Z_sq + P_qs Z_rp + P_ps Z_rq`, `P = X⁻¹`,
//!
//! half of it for each of the two entries that is on the diagonal.
//!
//! # References
//! `helmberg1996`, `mehrotra1992`

use nalgebra::{Cholesky, DMatrix, DVector};

/// The rows of a block: its upper triangle, column by column.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// Number of rows of the matrix.
    pub(super) size: usize,
    /// Constant and coefficients of the clique's moments, for each entry.
    pub(super) entries: Vec<(f64, Vec<(usize, f64)>)>,
}

impl Rows {
    /// Places of the entries.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.size).flat_map(|q| (0..=q).map(move |p| (p, q)))
    }

    /// `Σ y_i A_i`, and C with `constant`.
    pub(super) fn matrix(&self, y: &DVector<f64>, constant: bool) -> DMatrix<f64> {
        let mut x = DMatrix::zeros(self.size, self.size);
        for ((p, q), (c, terms)) in self.places().zip(&self.entries) {
            let value = terms.iter().map(|&(i, a)| a * y[i]).sum::<f64>() + if constant { *c } else { 0.0 };
            x[(p, q)] = value;
            x[(q, p)] = value;
        }
        x
    }

    /// Adds `tr(A_i M)` to entry i.
    pub(super) fn add_traces(&self, m: &DMatrix<f64>, sum: &mut DVector<f64>) {
        for ((p, q), (_, terms)) in self.places().zip(&self.entries) {
            let weight = m[(p, q)] + if p == q { 0.0 } else { m[(q, p)] };
            terms.iter().for_each(|&(i, a)| sum[i] += a * weight);
        }
    }

    /// Adds to M, where `M + Mᵀ` is the matrix of `tr(A_i X⁻¹ A_j Z)`: each pair of entries counts once.
    fn add_normal(&self, inverse: &DMatrix<f64>, z: &DMatrix<f64>, m: &mut DMatrix<f64>) {
        let (n, columns) = (self.size, m.ncols());
        let column = |m: &DMatrix<f64>, k: usize| m.as_slice()[k * n..(k + 1) * n].to_vec();
        let mut product = vec![0.0; columns];
        for (at, ((p, q), (_, own))) in self.places().zip(&self.entries).enumerate() {
            if own.is_empty() {
                continue;
            }
            product.fill(0.0);
            let half = if p == q { 0.5 } else { 1.0 };
            let (inverse_p, inverse_q) = (column(inverse, p), column(inverse, q));
            let (z_p, z_q) = (column(z, p), column(z, q));
            let mut entries = self.entries[..=at].iter();
            for s in 0..=q {
                let (p_s, q_s, zp_s, zq_s) =
                    (half * inverse_p[s], half * inverse_q[s], half * z_p[s], half * z_q[s]);
                for (r, (_, other)) in entries.by_ref().take(s + 1).enumerate() {
                    let k = inverse_q[r] * zp_s + inverse_p[r] * zq_s + q_s * z_p[r] + p_s * z_q[r];
                    let k = if r == s { 0.5 * k } else { k };
                    let k = if (r, s) == (p, q) { 0.5 * k } else { k };
                    other.iter().for_each(|&(j, a)| product[j] += k * a);
                }
            }
            for &(i, a) in own {
                let column = &mut m.as_mut_slice()[i * columns..(i + 1) * columns];
                column.iter_mut().zip(&product).for_each(|(m, x)| *m += a * x);
            }
        }
    }
}

/// A block in the course of the iteration.
#[derive(Debug, Clone)]
pub(super) struct Block {
    rows: Rows,
    x: DMatrix<f64>,
    pub(super) z: DMatrix<f64>,
    /// `X⁻¹`.
    inverse: DMatrix<f64>,
    /// What is missing of `X = C + Σ y_i A_i`.
    missing: DMatrix<f64>,
    step_x: DMatrix<f64>,
    step_z: DMatrix<f64>,
    /// Mehrotra's correction.
    correction: DMatrix<f64>,
}

impl Block {
    /// Begins at multiples of the identity.
    pub(super) fn new(rows: Rows, x: f64, z: f64) -> Self {
        let n = rows.size;
        let zero = DMatrix::zeros(n, n);
        Self {
            rows,
            x: DMatrix::identity(n, n) * x,
            z: DMatrix::identity(n, n) * z,
            inverse: zero.clone(),
            missing: zero.clone(),
            step_x: zero.clone(),
            step_z: zero.clone(),
            correction: zero,
        }
    }

    pub(super) fn size(&self) -> usize {
        self.rows.size
    }

    /// `⟨X, Z⟩` after steps of these lengths.
    pub(super) fn gap(&self, steps: [f64; 2]) -> f64 {
        let x = self.x.iter().zip(&self.step_x);
        let z = self.z.iter().zip(&self.step_z);
        x.zip(z).map(|((x, dx), (z, dz))| (x + steps[0] * dx) * (z + steps[1] * dz)).sum()
    }

    /// Forgets the last step.
    pub(super) fn rest(&mut self) {
        self.step_x.fill(0.0);
        self.step_z.fill(0.0);
        self.correction.fill(0.0);
    }

    /// Adds its part of H; `None` where X is no longer positive definite.
    pub(super) fn linearise(&mut self, y: &DVector<f64>, h: &mut DMatrix<f64>) -> Option<()> {
        self.inverse = Cholesky::new(self.x.clone())?.inverse();
        self.missing = self.rows.matrix(y, true) - &self.x;
        self.rows.add_normal(&self.inverse, &self.z, h);
        Some(())
    }

    /// Adds its part of the right-hand side, for the target μ.
    pub(super) fn add_right_hand_side(&self, mu: f64, sum: &mut DVector<f64>) {
        let part = &self.inverse * mu - &self.inverse * &self.missing * &self.z - &self.correction;
        self.rows.add_traces(&symmetric(part), sum);
    }

    /// The direction that follows from that of the moments.
    pub(super) fn direct(&mut self, mu: f64, step: &DVector<f64>) {
        self.step_x = self.rows.matrix(step, false) + &self.missing;
        let bent = symmetric(&self.inverse * &self.step_x * &self.z);
        self.step_z = &self.inverse * mu - &self.z - bent - &self.correction;
    }

    /// Takes the direction as the predictor.
    pub(super) fn correct(&mut self) {
        self.correction = symmetric(&self.inverse * &self.step_x * &self.step_z);
    }

    /// The largest steps up to these that keep X and Z positive semidefinite.
    pub(super) fn shorten(&self, steps: [f64; 2]) -> [f64; 2] {
        [shorten(&self.x, &self.step_x, steps[0]), shorten(&self.z, &self.step_z, steps[1])]
    }

    pub(super) fn advance(&mut self, steps: [f64; 2]) {
        self.x += &self.step_x * steps[0];
        self.z += &self.step_z * steps[1];
    }
}

fn symmetric(m: DMatrix<f64>) -> DMatrix<f64> {
    (&m + m.transpose()) * 0.5
}

/// The largest α up to `most` with `M + α D ⪰ 0`.
fn shorten(m: &DMatrix<f64>, direction: &DMatrix<f64>, most: f64) -> f64 {
    if m.nrows() == 1 {
        return if direction[0] < 0.0 { most.min(-m[0] / direction[0]) } else { most };
    }
    if !direction.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    // few blocks limit a step, and a factorisation is cheaper than eigenvalues
    if Cholesky::new(m + direction * most).is_some() {
        return most;
    }
    let Some(factor) = Cholesky::new(m.clone()) else { return 0.0 };
    let l = factor.l_dirty();
    let mut scaled = direction.clone();
    l.solve_lower_triangular_mut(&mut scaled);
    let mut scaled = scaled.transpose();
    l.solve_lower_triangular_mut(&mut scaled);
    let smallest = symmetric(scaled).symmetric_eigenvalues().min();
    if smallest < 0.0 { most.min(-1.0 / smallest) } else { most }
}
