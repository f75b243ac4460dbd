//! The smallest eigenvalue of a matrix that is affine in the accelerations, as a cone of the program of chains.
//!
//! `M(a) = M_0 + Σ (a_i − a°_i) M_i` has the smallest eigenvalue t with respect to a metric N where
//! `X = M(a) − t N ⪰ 0`. The program maximises t. With the multiplier `Z ⪰ 0`, the optimum has
//!
//! `slope_i − ⟨M_i, Z⟩ + … = 0`, `⟨N, Z⟩ = 1`, `X Z = 0`.
//!
//! # Direction
//! That of Nesterov and Todd. With `X = L Lᵀ`, `Z = R Rᵀ` and `Rᵀ L = U D Vᵀ`, the scaling `G = L V D^(−1/2)` makes
//! both the same diagonal matrix, `G⁻¹ X G⁻ᵀ = Gᵀ Z G = D`. In this scaling, with `E_ij = 2 / (D_i + D_j)`,
//!
//! `dX + dZ = σ μ D⁻¹ − D − E ∘ sym(dX° dZ°)`
//!
//! and the last term is Mehrotra's, from the predictor. Without dZ, the equations of the accelerations gain the squares
//! of the entries of dX. So the entries of `G⁻¹ M_i G⁻ᵀ` are forms of the program of chains like any other, and t is one
//! more unknown on its border.
//!
//! # References
//! `mehrotra1992`, `nesterov1997`, `todd1998`

use super::Stage;
use nalgebra::{Cholesky, DMatrix, DVector};

/// The matrix `M(a)`, of which the smallest eigenvalue is maximised.
#[derive(Clone)]
pub(crate) struct AffineMatrix {
    /// `M_0`.
    pub(crate) constant: DMatrix<f64>,
    /// `M_i`, by chain and node.
    pub(crate) changes: Vec<Vec<DMatrix<f64>>>,
    /// `a°`, by chain and node.
    pub(crate) around: Vec<Vec<f64>>,
    /// `N`, positive definite.
    pub(crate) metric: DMatrix<f64>,
}

impl AffineMatrix {
    pub(crate) fn at(&self, x: &[Vec<Stage>]) -> DMatrix<f64> {
        let mut matrix = self.constant.clone();
        for ((changes, around), x) in self.changes.iter().zip(&self.around).zip(x) {
            for ((change, around), z) in changes.iter().zip(around).zip(x) {
                matrix += change * (z[0] - around);
            }
        }
        matrix
    }

    /// Number of rows of the matrix.
    pub(crate) fn size(&self) -> usize {
        self.constant.nrows()
    }
}

/// The cone in the course of the iteration.
#[derive(Clone)]
pub(crate) struct Cone {
    pub(crate) t: f64,
    x: DMatrix<f64>,
    z: DMatrix<f64>,
}

/// A direction in the scaling, or what it is to add up to.
pub(crate) struct ConeStep {
    pub(crate) t: f64,
    x: DMatrix<f64>,
    z: DMatrix<f64>,
}

/// How often the first distance of t from the smallest eigenvalue is doubled.
const DOUBLED: i32 = 60;

impl Cone {
    /// Begins with t below the smallest eigenvalue at a motion, and `Z = μ X⁻¹`. `None` where there is no such t.
    pub(crate) fn new(matrix: &AffineMatrix, x: &[Vec<Stage>], mean: f64) -> Option<Self> {
        let at = matrix.at(x);
        (0..DOUBLED).find_map(|k| {
            let t = 1.0 - mean * 2.0_f64.powi(k);
            let x = &at - &matrix.metric * t;
            let z = Cholesky::new(x.clone())?.inverse() * mean;
            Some(Self { t, x, z })
        })
    }

    /// `⟨X, Z⟩`.
    pub(crate) fn gap(&self) -> f64 {
        self.x.dot(&self.z)
    }

    #[cfg(test)]
    pub(crate) fn multiplier(&self) -> &DMatrix<f64> {
        &self.z
    }

    /// The scaling in which X and Z are the same; `None` where rounding has left one of them indefinite.
    pub(crate) fn scaling(&self) -> Option<Scaling> {
        let l = Cholesky::new(self.x.clone())?.unpack();
        let r = Cholesky::new(self.z.clone())?.unpack();
        let svd = r.tr_mul(&l).svd(false, true);
        let d = svd.singular_values;
        // G⁻¹ = D^(1/2) Vᵀ L⁻¹
        let mut inverse = svd.v_t? * l.solve_lower_triangular(&DMatrix::identity(d.len(), d.len()))?;
        for (mut row, d) in inverse.row_iter_mut().zip(d.iter()) {
            row *= d.sqrt();
        }
        d.iter().all(|d| *d > 0.0 && d.is_finite()).then_some(Scaling { inverse, d })
    }

    /// Goes a part of the way; X is that of the new motion and t.
    pub(crate) fn advance(
        &mut self,
        scaling: &Scaling,
        step: &ConeStep,
        part: f64,
        matrix: &AffineMatrix,
        x: &[Vec<Stage>],
    ) {
        self.t += part * step.t;
        self.x = matrix.at(x) - &matrix.metric * self.t;
        let change = scaling.inverse.tr_mul(&step.z) * &scaling.inverse;
        self.z += (&change + change.transpose()) * (0.5 * part);
    }
}

/// The scaling of Nesterov and Todd.
pub(crate) struct Scaling {
    /// `G⁻¹`.
    inverse: DMatrix<f64>,
    d: DVector<f64>,
}

impl Scaling {
    /// The scaled entries of a matrix, so that the product of two is that of the matrices.
    pub(crate) fn entries(&self, matrix: &DMatrix<f64>) -> Vec<f64> {
        triangle(&(&self.inverse * matrix * self.inverse.transpose()))
    }

    /// What `Z + dZ + dX` is to be in the scaling: for the predictor, or for a centre after it.
    pub(crate) fn pull(&self, centre: Option<(f64, &ConeStep)>) -> DMatrix<f64> {
        let size = self.d.len();
        let Some((centre, predictor)) = centre else { return DMatrix::zeros(size, size) };
        let product = &predictor.x * &predictor.z;
        DMatrix::from_fn(size, size, |i, j| {
            let bent = (product[(i, j)] + product[(j, i)]) / (self.d[i] + self.d[j]);
            if i == j { centre / self.d[i] - bent } else { -bent }
        })
    }

    /// The direction with these scaled entries of dX, and the same as the multipliers have them.
    pub(crate) fn step(
        &self,
        t: f64,
        entries: &[f64],
        of_multipliers: &[f64],
        pull: &DMatrix<f64>,
    ) -> ConeStep {
        let x = from_triangle(entries, self.d.len());
        let mut z = pull - from_triangle(of_multipliers, self.d.len());
        (0..self.d.len()).for_each(|i| z[(i, i)] -= self.d[i]);
        ConeStep { t, x, z }
    }

    /// The share of a direction at which X or Z ceases to be positive definite.
    pub(crate) fn furthest(&self, step: &ConeStep) -> f64 {
        let of = |change: &DMatrix<f64>| {
            let scaled = DMatrix::from_fn(self.d.len(), self.d.len(), |i, j| {
                change[(i, j)] / (self.d[i] * self.d[j]).sqrt()
            });
            if !scaled.iter().all(|x| x.is_finite()) {
                return 0.0;
            }
            let smallest = scaled.symmetric_eigenvalues().min();
            if smallest < 0.0 { -1.0 / smallest } else { f64::INFINITY }
        };
        of(&step.x).min(of(&step.z))
    }

    /// `⟨X, Z⟩` after a part of the way.
    pub(crate) fn gap_after(&self, step: &ConeStep, part: f64) -> f64 {
        let d = DMatrix::from_diagonal(&self.d);
        (&d + &step.x * part).dot(&(&d + &step.z * part))
    }
}

/// The upper triangle, column by column, off-diagonal entries times `√2`.
pub(crate) fn triangle(matrix: &DMatrix<f64>) -> Vec<f64> {
    let mut entries = Vec::new();
    for j in 0..matrix.ncols() {
        entries.extend((0..j).map(|i| (matrix[(i, j)] + matrix[(j, i)]) * std::f64::consts::FRAC_1_SQRT_2));
        entries.push(matrix[(j, j)]);
    }
    entries
}

fn from_triangle(entries: &[f64], size: usize) -> DMatrix<f64> {
    DMatrix::from_fn(size, size, |i, j| {
        let (low, high) = (i.min(j), i.max(j));
        let entry = entries[high * (high + 1) / 2 + low];
        if i == j { entry } else { entry * std::f64::consts::FRAC_1_SQRT_2 }
    })
}
