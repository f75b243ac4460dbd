//! The problem of one part of a design: the axes that are designed together.
//!
//! # Gravity
//! A recording determines the readings at rest `r` in the place of the biases
//! ([`GravityMarginal`]). The covariance of the parameters is
//! `C = floor + C'`, `C' = G C_q Gᵀ`, with `C_q` that of `q = (r, S)` and a constant `G`. The search works with
//! `C'`, the part that the motion decides: criteria A, c and I differ by a constant from those of `C`, which would
//! hide the motion in the rounding of the tilt's share. The largest eigenvalue and the largest variance of `C` are
//! those of the tilt, whatever the motion; E and M look at `C'` as well. D is `ln det (floor + C')`.
//! A form `⟨Ω, C'⁻¹⟩` is the form `⟨G⁻¹ Ω G⁻ᵀ, F⟩` of the information on `q`.

use crate::limits::Region;
use calibrant_core::information::{Criterion, GravityMarginal, Linearised, PartInformation, covariance};
use nalgebra::{DMatrix, SMatrix, SVector};

/// The problem of one part: D axes that are designed together.
pub(crate) struct Part<const D: usize, const P: usize> {
    pub(crate) information: PartInformation<D, P>,
    pub(crate) regions: [Region; D],
    pub(crate) criterion: Criterion,
    /// Information that is there already: on the parameters, or on `q` where there is gravity.
    pub(crate) prior: SMatrix<f64, P, P>,
    pub(crate) gravity: Option<PartGravity<P>>,
    /// An admissible motion, and its relative distance from every limit.
    pub(crate) inside: Vec<SVector<f64, D>>,
    pub(crate) slack: f64,
}

/// The nodes of a motion on D axes.
pub(crate) type Nodes<const D: usize> = Vec<SVector<f64, D>>;

/// The point this part of the way from one motion to another.
pub(crate) fn mix<const D: usize>(from: &[SVector<f64, D>], to: &[SVector<f64, D>], part: f64) -> Nodes<D> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * part).collect()
}

/// The way from the readings at rest to the biases, for the parameters of one part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PartGravity<const P: usize> {
    /// `G`, and its inverse.
    through: SMatrix<f64, P, P>,
    inverse: SMatrix<f64, P, P>,
    floor: DMatrix<f64>,
}

impl<const P: usize> PartGravity<P> {
    /// That of the parameters at these places. `None` where a prior leaves `G` singular in rounding.
    pub(crate) fn of(marginal: &GravityMarginal, slots: &[usize; P]) -> Option<Self> {
        let own = marginal.restricted(slots);
        let through = SMatrix::<f64, P, P>::from_fn(|i, j| own.through[(i, j)]);
        let inverse = own.through.try_inverse()?;
        Some(Self { through, inverse: SMatrix::from_fn(|i, j| inverse[(i, j)]), floor: own.floor })
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// The covariance that the motion decides: `C`, or `C'` where there is gravity.
    pub(crate) fn covariance(&self, at: &Linearised<D, P>) -> Option<DMatrix<f64>> {
        let f = at.information + self.prior;
        let c = covariance(&DMatrix::from_fn(P, P, |i, j| f[(i, j)]))?;
        let Some(PartGravity { through, .. }) = &self.gravity else { return Some(c) };
        let c = through * SMatrix::<f64, P, P>::from_fn(|i, j| c[(i, j)]) * through.transpose();
        Some(DMatrix::from_fn(P, P, |i, j| 0.5 * (c[(i, j)] + c[(j, i)])))
    }

    /// The inverse of [`covariance`](Self::covariance).
    pub(crate) fn inverse_covariance(&self, at: &Linearised<D, P>) -> SMatrix<f64, P, P> {
        self.on_inverse_covariance(&(at.information + self.prior))
    }

    /// A change of the information as one of the inverse covariance.
    pub(crate) fn on_inverse_covariance(&self, f: &SMatrix<f64, P, P>) -> SMatrix<f64, P, P> {
        self.gravity.as_ref().map_or(*f, |gravity| gravity.inverse.transpose() * f * gravity.inverse)
    }

    /// Value of the criterion at this covariance.
    pub(crate) fn criterion_at(&self, c: &DMatrix<f64>) -> f64 {
        match &self.floor_of_d() {
            Some(floor) => self.criterion.value(&(*floor + c)),
            None => self.criterion.value(c),
        }
    }

    /// The floor, where the criterion does not only grow by it.
    pub(crate) fn floor_of_d(&self) -> Option<&DMatrix<f64>> {
        match (&self.criterion, &self.gravity) {
            (Criterion::D(_), Some(gravity)) => Some(&gravity.floor),
            _ => None,
        }
    }

    /// The form `⟨Ω, ·⟩` of the inverse covariance as a form of the information.
    pub(crate) fn on_information(&self, omega: &SMatrix<f64, P, P>) -> SMatrix<f64, P, P> {
        match &self.gravity {
            Some(PartGravity { inverse, .. }) => inverse * omega * inverse.transpose(),
            None => *omega,
        }
    }

    /// A factor `R` of such a form, `Ω = R Rᵀ`, in the same way.
    pub(crate) fn factor_on_information(&self, factor: SMatrix<f64, P, P>) -> SMatrix<f64, P, P> {
        self.gravity.as_ref().map_or(factor, |gravity| gravity.inverse * factor)
    }
}
