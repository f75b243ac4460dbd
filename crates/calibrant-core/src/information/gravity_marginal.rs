//! Gravity in the information of a motion, with its tilt marginalised.
//!
//! With gravity `γ` and its unknown offset `o ~ N(0, P)` ([`MotionGravity`]) the readings are
//!
//! `y = S (α + γ + o) + b + ν = S α + r + ν`, `r = b + S (γ + o)`
//!
//! So a recording sees the **reading at rest** `r` in the place of the bias, and gravity changes nothing else:
//! kernels, trust, known ends and their derivatives stay as they are. They give the information `F` on
//! `q = (r, S)`. The parameters `p = (b, S)` follow by
//!
//! `p = T q − J o`, `T: b_i = r_i − Σ_k S_ik γ_k`, `J = ∂r/∂o = S` in the rows of the biases.
//!
//! The first term is exact. The second is linear for given `S`. Let `N = J P Jᵀ`, and let `M₀` be the
//! information on `p` that is there beforehand. `T q = p + J o`, so given `T q` the parameters have the
//! covariance `(N⁻¹ + M₀)⁻¹ = A N` and the gain `A = (I + N M₀)⁻¹`; and `M₀ A` is the prior of `T q`. Hence
//!
//! `C = A N + A T (F + Tᵀ M₀ A T)⁻¹ Tᵀ Aᵀ`
//!
//! which is the block of `p` in the inverse of the joint information of `p` and `o`. Nothing is divided by `N`, so that an
//! exact axis is no special case. The first term is the **floor**: no motion changes it. Without `M₀` it is
//! `N`, and the covariance of the biases grows by `S P Sᵀ`.

use super::{Undetermined, covariance};
use crate::motion::MotionGravity;
use crate::sensor::{ParameterList, Quantity, SensorParameters};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// The way from the information on the readings at rest and `S` to the covariance of biases and `S`.
#[derive(Debug, Clone, PartialEq)]
pub struct GravityMarginal {
    /// `A T`, p × p.
    pub through: DMatrix<f64>,
    /// `A N`: the covariance that no motion changes.
    pub floor: DMatrix<f64>,
    /// `Tᵀ M₀ A T`: what the prior says of the readings at rest and `S`.
    pub prior: DMatrix<f64>,
}

impl GravityMarginal {
    /// That of this gravity for a sensor like `at`, with the information `prior` on its parameters.
    ///
    /// # Examples
    /// One axis that points up, with gravity known to 0.1 m/s²: the bias is no better known than that.
    /// ```
    /// use calibrant_core::information::GravityMarginal;
    /// use calibrant_core::motion::MotionGravity;
    /// use calibrant_core::sensor::{ParameterList, SensorModel, SensorParameters};
    /// use nalgebra::{DMatrix, Vector3};
    /// let gravity = MotionGravity { force_mps2: Vector3::new(10.0, 0.0, 0.0), sd_mps2: 0.1, tilt_sd_rad: 0.0 };
    /// let list = ParameterList::new(1, SensorModel::ScaleBias);
    /// let marginal = GravityMarginal::new(&list, &SensorParameters::identity(), &gravity, None);
    /// // information on the reading at rest and the scale factor: variances 4e-4 and 1e-4
    /// let q = DMatrix::from_row_slice(2, 2, &[4e-4, 0.0, 0.0, 1e-4]);
    /// let c = marginal.covariance(&q);
    /// assert!((c[(0, 0)] - (0.1 * 0.1 + 4e-4 + 10.0 * 10.0 * 1e-4)).abs() < 1e-15, "bias");
    /// assert!((c[(0, 1)] + 10.0 * 1e-4).abs() < 1e-15, "bias and scale factor correlate");
    /// ```
    #[must_use]
    pub fn new(
        list: &ParameterList,
        at: &SensorParameters,
        gravity: &MotionGravity,
        prior: Option<&DMatrix<f64>>,
    ) -> Self {
        let bias = from_reading_at_rest(list, &gravity.force_mps2);
        let response = offset_response(list, &at.matrix);
        let offset = &response * gravity.offset_covariance() * response.transpose();
        let Some(prior) = prior else {
            let prior = DMatrix::zeros(list.len(), list.len());
            return Self { through: bias, floor: offset, prior };
        };
        let size = list.len();
        let inverse = (DMatrix::identity(size, size) + &offset * prior).try_inverse();
        // A N is positive semidefinite wherever N and M₀ are, so I + N M₀ has no zero eigenvalue
        let gain = inverse.unwrap_or_else(|| DMatrix::identity(size, size));
        let through = &gain * &bias;
        Self {
            floor: symmetric(&(&gain * &offset)),
            prior: symmetric(&(bias.transpose() * prior * &through)),
            through,
        }
    }

    /// Covariance of the parameters from that of the readings at rest and `S`, the prior among its information.
    #[must_use]
    pub fn covariance(&self, at_rest: &DMatrix<f64>) -> DMatrix<f64> {
        symmetric(&(&self.floor + &self.through * at_rest * self.through.transpose()))
    }

    /// Information on the parameters behind [`covariance`](Self::covariance), at this information on the
    /// readings at rest and `S`, the prior among it. `None` where they are not determined.
    #[must_use]
    pub fn information(&self, at_rest: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        covariance(&self.covariance(&covariance(at_rest)?))
    }

    /// The same for the parameters at these places, which share nothing with the others.
    #[must_use]
    pub fn restricted(&self, places: &[usize]) -> Self {
        let pick = |of: &DMatrix<f64>| of.select_rows(places).select_columns(places);
        Self { through: pick(&self.through), floor: pick(&self.floor), prior: pick(&self.prior) }
    }
}

/// `T`: the parameters from the readings at rest, in the places of the biases, and `S`.
#[must_use]
pub(crate) fn from_reading_at_rest(list: &ParameterList, force_mps2: &Vector3<f64>) -> DMatrix<f64> {
    let mut of = DMatrix::identity(list.len(), list.len());
    for (bias, quantity) in list.quantities().iter().enumerate() {
        let Quantity::Bias(axis) = quantity else { continue };
        for (place, other) in list.quantities().iter().enumerate() {
            if !matches!(other, Quantity::Bias(_)) {
                of[(bias, place)] =
                    -other.derivative(&SensorParameters::identity(), force_mps2)[axis.index()];
            }
        }
    }
    of
}

/// `J`: the change of the readings at rest with an offset of the force, p × 3.
#[must_use]
pub(crate) fn offset_response(list: &ParameterList, matrix: &Matrix3<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(list.len(), 3, |place, k| match list.quantities()[place] {
        Quantity::Bias(axis) => matrix[(axis.index(), k)],
        _ => 0.0,
    })
}

/// Groups of undetermined parameters of a recording with gravity: where an entry of `S` is undetermined and
/// gravity acts on it, so is the bias of its reading. `slots` are the places of the parameters in the list.
#[must_use]
pub fn with_biases(
    groups: &[Undetermined],
    list: &ParameterList,
    slots: &[usize],
    gravity: Option<&MotionGravity>,
) -> Vec<Undetermined> {
    let mut groups = groups.to_vec();
    let Some(gravity) = gravity else { return groups };
    let of = from_reading_at_rest(list, &gravity.force_mps2);
    for group in &mut groups {
        let also = (0..slots.len()).filter(|&k| {
            group.parameters.iter().any(|&other| other != k && of[(slots[k], slots[other])] != 0.0)
        });
        let also: Vec<usize> = also.collect();
        group.parameters.extend(also);
        group.parameters.sort_unstable();
        group.parameters.dedup();
    }
    groups
}

fn symmetric(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorModel;

    /// The block of the parameters in the inverse of the joint information of parameters and offset.
    #[test]
    fn the_covariance_is_that_of_the_joint_information() {
        let gravity =
            MotionGravity { force_mps2: Vector3::new(1.0, -2.0, 9.5), sd_mps2: 0.03, tilt_sd_rad: 0.01 };
        let matrix = Matrix3::new(1.1, 0.1, -0.05, 0.02, 0.9, 0.03, 0.04, -0.02, 1.05);
        for model in [SensorModel::Full, SensorModel::ScaleBias] {
            let list = ParameterList::new(3, model);
            let matrix =
                if model == SensorModel::Full { matrix } else { Matrix3::from_diagonal(&matrix.diagonal()) };
            let at = SensorParameters::linear(Vector3::new(0.1, 0.2, -0.3), matrix);
            let p = list.len();
            let wave = |k: f64| DMatrix::from_fn(p, p, |i, j| (k * (3 * i + 5 * j + i * j) as f64).sin());
            let f = wave(1.0) * wave(1.0).transpose() * 100.0 + DMatrix::identity(p, p);
            let known = wave(2.0).columns(0, 3) * wave(2.0).columns(0, 3).transpose();
            for prior in [None, Some(&known)] {
                let marginal = GravityMarginal::new(&list, &at, &gravity, prior);
                // q = T⁻¹ (p + J o)
                let of_p = from_reading_at_rest(&list, &gravity.force_mps2).try_inverse().expect("regular");
                let of_o = &of_p * offset_response(&list, &at.matrix);
                let mut joint = DMatrix::zeros(p + 3, p + 3);
                joint.view_mut((0, 0), (p, p)).copy_from(&(of_p.transpose() * &f * &of_p));
                joint.view_mut((0, p), (p, 3)).copy_from(&(of_p.transpose() * &f * &of_o));
                joint.view_mut((p, 0), (3, p)).copy_from(&(of_o.transpose() * &f * &of_p));
                let own = gravity.offset_covariance().try_inverse().expect("regular");
                joint.view_mut((p, p), (3, 3)).copy_from(&(of_o.transpose() * &f * &of_o + own));
                if let Some(prior) = prior {
                    let mut block = joint.view_mut((0, 0), (p, p));
                    block += prior;
                }
                let dense = covariance(&joint).expect("regular").view((0, 0), (p, p)).into_owned();
                let at_rest = covariance(&(&f + &marginal.prior)).expect("regular");
                let own = marginal.covariance(&at_rest);
                assert!((&own - &dense).amax() < 1e-10 * dense.amax(), "{own} {dense}");
            }
        }
    }
}
