//! A term of the least squares: observations of one kind, with their residuals, derivatives and weights.

use crate::estimate::imu::model::{GravityResidual, ImuModel, State};
use crate::sensor::entry_vector::ENTRIES;
use crate::sensor::{ImuParameters, ImuQuantity, SensorKind};
use nalgebra::{Matrix3, Matrix3x2, Matrix3xX, SMatrix, Vector3};
use std::fmt::Debug;

/// Observations of one kind.
pub(crate) trait Term: Debug + Sync {
    /// The numbers of one observation: at most three.
    fn rows(&self) -> usize;

    /// Where they stand.
    fn place(&self) -> Place;

    /// How many there are.
    fn count(&self, model: &ImuModel<'_>) -> usize;

    /// The residual of one. `None` where it is not there or does not count.
    fn residual(&self, at: &At<'_>, k: usize) -> Option<Residual>;

    /// The derivatives of one that has a residual.
    fn derivatives(&self, at: &At<'_>, k: usize) -> Derivatives;

    /// Derivative of what is expected with respect to the unknowns of the Earth's rate, in the variables of the linear problem (`earth_rate`).
    fn by_earth(&self, at: &At<'_>, _k: usize) -> Matrix3xX<f64> {
        Matrix3xX::zeros(at.model.earth.unknowns().len())
    }

    /// Do these observations tell a quantity of the gyroscope, so that it takes nothing of the rotations?
    fn tells(&self, _model: &ImuModel<'_>, _quantity: ImuQuantity, _imu: &ImuParameters) -> bool {
        false
    }
}

/// Where the observations of a term stand in the chain of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// The k-th sees the direction of hold k.
    Hold,
    /// The k-th joins the directions of holds k and k + 1.
    BetweenHolds,
    /// They see no direction.
    Alone,
}

/// Where the terms are evaluated.
#[derive(Clone, Copy)]
pub(crate) struct At<'a> {
    pub(crate) model: &'a ImuModel<'a>,
    pub(crate) state: &'a State,
    /// The rotations, integrated at this state.
    pub(crate) rotations: &'a [Option<GravityResidual>],
}

/// What was observed less what is expected. Rows that a term does not have are zero, and so is their weight.
pub(crate) struct Residual {
    pub(crate) r: Vector3<f64>,
    pub(crate) weight: Weight,
}

/// An inverse covariance.
pub(crate) enum Weight {
    /// Of rows that are independent.
    Rows(Vector3<f64>),
    Full(Matrix3<f64>),
}

impl Weight {
    pub(crate) fn matrix(&self) -> Matrix3<f64> {
        match self {
            Self::Rows(weights) => Matrix3::from_diagonal(weights),
            Self::Full(weight) => *weight,
        }
    }
}

impl Residual {
    /// Its square in standard deviations.
    pub(crate) fn chi2(&self) -> f64 {
        match &self.weight {
            Weight::Rows(weights) => self.r.component_mul(&self.r).dot(weights),
            Weight::Full(weight) => self.r.dot(&(weight * self.r)),
        }
    }
}

/// A column for each quantity of a model; those beyond its last are zero.
pub(crate) type ByQuantities = SMatrix<f64, 3, ENTRIES>;

/// Derivatives of what is expected of one observation.
pub(crate) struct Derivatives {
    /// With respect to turns of the direction before it, and of that at its hold or after it.
    pub(crate) by_directions: [Option<Matrix3x2<f64>>; 2],
    pub(crate) by_quantities: ByQuantities,
}

/// The columns of the quantities of one sensor.
pub(crate) fn by_quantities(
    model: &ImuModel<'_>,
    sensor_kind: SensorKind,
    derivative: impl Fn(ImuQuantity) -> Vector3<f64>,
) -> ByQuantities {
    let mut columns = ByQuantities::zeros();
    for (k, quantity) in model.quantities.iter().enumerate() {
        if quantity.sensor_kind() == sensor_kind {
            columns.set_column(k, &derivative(*quantity));
        }
    }
    columns
}
