//! The information of one hold on the parameters, for any knowledge of its direction.
//!
//! The mean reading of a hold is `ȳ = S f + b + ε` with `f = g u`, and `ε` of covariance Σ. The direction is
//! known with a standard deviation φ about each axis across it. Its error moves the reading by
//! `g S T δ`, with T the two tangents of u. So the residual has the covariance
//!
//! `N = Σ + g² φ² S (I − u uᵀ) Sᵀ`, and `m(u) = Gᵀ N⁻¹ G` with `G = ∂(S f + b)/∂p`.
//!
//! If nothing is known of the direction (φ → ∞), only the component across `S T` is left. It is along
//! `v = S⁻ᵀ u`, and `N⁻¹ = v vᵀ / (vᵀ Σ v)`: one equation a hold, `|f| = g`.
//!
//! The reading is linear in the twelve entries of `(b, S)`. Therefore the information is summed there, as
//! `N⁻¹ ⊗ φ φᵀ` with `φ = (1, f)`, and the parameters follow by one linear map. Where terms bend the response,
//! there is no such map: `m(u)` is summed as it is, with the slope of the response at f in place of S.

use super::problem::{DirectionKnowledge, PoseProblem};
use calibrant_core::sensor::{ParameterList, Quantity, SensorParameters};
use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3, Vector4};
use std::ops::AddAssign;

/// A matrix over the entries `b_x, S_xx, S_xy, S_xz, b_y, …`.
type Entries = SMatrix<f64, 12, 12>;

/// Summed information of holds.
#[expect(clippy::large_enum_variant, reason = "few are made, and the large one is the usual one")]
#[derive(Clone)]
pub(super) enum Sum {
    /// On the entries of a linear response.
    OnEntries(Entries),
    /// On the parameters of one that is bent.
    OnParameters(DMatrix<f64>),
}

impl AddAssign<&Sum> for Sum {
    fn add_assign(&mut self, other: &Sum) {
        match (self, other) {
            (Self::OnEntries(sum), Self::OnEntries(other)) => *sum += other,
            (Self::OnParameters(sum), Self::OnParameters(other)) => *sum += other,
            // one problem has one kind
            _ => {}
        }
    }
}

/// The information of holds of one problem.
pub(super) struct HoldInformation {
    /// Derivative of the entries with respect to the parameters, 12 × p.
    entries: DMatrix<f64>,
    list: ParameterList,
    at: SensorParameters,
    /// Do terms bend the response?
    is_bent: bool,
    /// `S⁻ᵀ`.
    inverse_transpose: Matrix3<f64>,
    variance: Vector3<f64>,
    gravity: f64,
    directions: DirectionKnowledge,
    prior: DMatrix<f64>,
}

impl HoldInformation {
    /// That of a problem; `None` where the matrix S is singular.
    pub(super) fn new(problem: &PoseProblem) -> Option<Self> {
        let quantities = problem.list.quantities();
        let mut entries = DMatrix::zeros(12, quantities.len());
        for (k, quantity) in quantities.iter().enumerate() {
            let bias = quantity.derivative(&problem.at, &Vector3::zeros());
            for row in 0..3 {
                entries[(4 * row, k)] = bias[row];
                for column in 0..3 {
                    let along = quantity.derivative(&problem.at, &Vector3::ith(column, 1.0));
                    entries[(4 * row + 1 + column, k)] = along[row] - bias[row];
                }
            }
        }
        let size = quantities.len();
        Some(Self {
            entries,
            list: problem.list.clone(),
            at: problem.at,
            is_bent: quantities.iter().any(|quantity| matches!(quantity, Quantity::Nonlinear(..))),
            inverse_transpose: problem.at.matrix.try_inverse()?.transpose(),
            variance: problem.mean_sd.component_mul(&problem.mean_sd),
            gravity: problem.gravity_mps2,
            directions: problem.directions,
            prior: problem.prior.clone().unwrap_or_else(|| DMatrix::zeros(size, size)),
        })
    }

    /// `N⁻¹`.
    pub(super) fn weight(&self, u: &Vector3<f64>) -> Matrix3<f64> {
        match self.directions {
            DirectionKnowledge::Unknown => {
                let v = match self.at.nonlinearity.is_none() {
                    true => self.inverse_transpose * u,
                    false => {
                        self.slope(u).try_inverse().map_or(self.inverse_transpose * u, |of| of.tr_mul(u))
                    }
                };
                v * v.transpose() / v.component_mul(&v).dot(&self.variance)
            }
            DirectionKnowledge::Known { sd_rad } => {
                let across = self.slope(u) * (Matrix3::identity() - u * u.transpose());
                let tilt = self.gravity * sd_rad;
                let n = Matrix3::from_diagonal(&self.variance) + across * across.transpose() * tilt * tilt;
                n.try_inverse().unwrap_or_else(Matrix3::zeros)
            }
        }
    }

    /// `∂y/∂f`.
    fn slope(&self, u: &Vector3<f64>) -> Matrix3<f64> {
        self.at.by_stimulus(&(u * self.gravity))
    }

    /// `G`, 3 × p.
    fn sensitivity(&self, u: &Vector3<f64>) -> DMatrix<f64> {
        let (force, quantities) = (u * self.gravity, self.list.quantities());
        let columns: Vec<Vector3<f64>> =
            quantities.iter().map(|of| of.derivative(&self.at, &force)).collect();
        DMatrix::from_fn(3, columns.len(), |row, k| columns[k][row])
    }

    /// No holds.
    pub(super) fn nothing(&self) -> Sum {
        match self.is_bent {
            false => Sum::OnEntries(Entries::zeros()),
            true => Sum::OnParameters(DMatrix::zeros(self.list.len(), self.list.len())),
        }
    }

    fn regressors(&self, u: &Vector3<f64>) -> Vector4<f64> {
        Vector4::new(1.0, self.gravity * u.x, self.gravity * u.y, self.gravity * u.z)
    }

    /// `Σ w_k m(u_k)`.
    pub(super) fn sum<'a>(&self, poses: impl Iterator<Item = (&'a Vector3<f64>, f64)>) -> Sum {
        if self.is_bent {
            let mut sum = DMatrix::zeros(self.list.len(), self.list.len());
            for (u, share) in poses {
                let g = self.sensitivity(u);
                sum += g.tr_mul(&(self.weight(u) * share * &g));
            }
            return Sum::OnParameters(sum);
        }
        let mut sum = Entries::zeros();
        for (u, share) in poses {
            let (weight, phi) = (self.weight(u) * share, self.regressors(u));
            let square = phi * phi.transpose();
            for row in 0..3 {
                for column in 0..3 {
                    let mut block = sum.fixed_view_mut::<4, 4>(4 * row, 4 * column);
                    block += square * weight[(row, column)];
                }
            }
        }
        Sum::OnEntries(sum)
    }

    /// `Σ w_k m(u_k)` from the sum, p × p.
    fn without_prior(&self, sum: &Sum) -> DMatrix<f64> {
        match sum {
            Sum::OnEntries(sum) => self.entries.tr_mul(&(sum * &self.entries)),
            Sum::OnParameters(sum) => sum.clone(),
        }
    }

    /// `M = M₀ + Σ w_k m(u_k)` from the sum, p × p.
    pub(super) fn of_parameters(&self, sum: &Sum) -> DMatrix<f64> {
        self.without_prior(sum) + &self.prior
    }

    /// `m(u)`, p × p.
    pub(super) fn of_hold(&self, u: &Vector3<f64>) -> DMatrix<f64> {
        self.without_prior(&self.sum(std::iter::once((u, 1.0))))
    }

    /// `Gᵀ N⁻¹`, p × 3.
    pub(super) fn on_reading(&self, u: &Vector3<f64>) -> DMatrix<f64> {
        let (weight, phi) = (self.weight(u), self.regressors(u));
        if self.is_bent {
            return self.sensitivity(u).tr_mul(&DMatrix::from_column_slice(3, 3, weight.as_slice()));
        }
        let on_entries = DMatrix::from_fn(12, 3, |entry, axis| phi[entry % 4] * weight[(entry / 4, axis)]);
        self.entries.tr_mul(&on_entries)
    }

    pub(super) fn prior(&self) -> &DMatrix<f64> {
        &self.prior
    }

    /// The gain `d(u) = tr(Ω m(u))` as a function of the direction.
    pub(super) fn gain(&self, omega: &DMatrix<f64>) -> Gain<'_> {
        if self.is_bent {
            return Gain { information: self, omega: Sum::OnParameters(omega.clone()) };
        }
        let on_entries = &self.entries * omega * self.entries.transpose();
        Gain { information: self, omega: Sum::OnEntries(Entries::from_fn(|i, j| on_entries[(i, j)])) }
    }
}

/// `d(u) = tr(Ω m(u))`: how much a hold in the direction u lowers the criterion, to first order.
pub(super) struct Gain<'a> {
    information: &'a HoldInformation,
    omega: Sum,
}

/// Step of the differences, rad.
const STEP: f64 = 1e-4;

impl Gain<'_> {
    /// d(u).
    pub(super) fn at(&self, u: &Vector3<f64>) -> f64 {
        let (weight, phi) = (self.information.weight(u), self.information.regressors(u));
        let omega = match &self.omega {
            Sum::OnEntries(omega) => omega,
            Sum::OnParameters(omega) => {
                let g = self.information.sensitivity(u);
                return ((&g * omega).tr_mul(&(weight * &g))).trace();
            }
        };
        let mut gain = 0.0;
        for row in 0..3 {
            for column in 0..3 {
                let block = omega.fixed_view::<4, 4>(4 * row, 4 * column);
                gain += weight[(row, column)] * phi.dot(&(block * phi));
            }
        }
        gain
    }

    /// Its slope along the sphere, a vector across u. By differences of fourth order: d is nearly a
    /// polynomial of degree 4, so that they are exact to about eleven digits.
    pub(super) fn slope(&self, u: &Vector3<f64>) -> Vector3<f64> {
        let one = super::allowed::perpendicular(u);
        let other = u.cross(&one);
        let along = |t: &Vector3<f64>| {
            let at = |angle: f64| self.at(&(u * angle.cos() + t * angle.sin()));
            (8.0 * (at(STEP) - at(-STEP)) - (at(2.0 * STEP) - at(-2.0 * STEP))) / (12.0 * STEP)
        };
        one * along(&one) + other * along(&other)
    }
}
