//! The gyroscope's parameters and the Earth's rate as a linear problem, directions fixed: the rest of it beside the rotations, and the weights of these.

use crate::error::Result;
use crate::estimate::imu::model::{GravityResiduals, ImuModel, State, singular};
use crate::estimate::imu::terms::list::TERMS;
use crate::estimate::imu::terms::term::{At, Place, Residual};
use crate::estimate::imu::variance_components::rotations::{
    Rest, RotationWeights, solve_again, weigh_rotations,
};
use nalgebra::{DMatrix, DVector, Matrix3xX};
use std::ops::SubAssign;

/// What all terms but the rotations say of the gyroscope and the Earth's rate, directions fixed. In place of `Γ` stands what
/// [`EarthRate`](crate::estimate::imu::earth_rate) makes of it.
fn rest(at: &At<'_>) -> Rest {
    let (model, imu) = (at.model, &at.state.imu);
    let places = model.gyroscope_places();
    let unknowns = model.earth.unknowns();
    let size = places.len() + unknowns.len();
    let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for term in TERMS.into_iter().filter(|term| term.place() != Place::BetweenHolds) {
        for k in 0..term.count(model) {
            let Some(Residual { r, weight }) = term.residual(at, k) else { continue };
            let (weight, by_quantities) = (weight.matrix(), term.derivatives(at, k).by_quantities);
            let mut columns = Matrix3xX::zeros(size);
            places.iter().enumerate().for_each(|(i, &k)| columns.set_column(i, &by_quantities.column(k)));
            columns.columns_mut(places.len(), unknowns.len()).copy_from(&term.by_earth(at, k));
            for (i, column) in columns.column_iter().enumerate() {
                if column.iter().all(|entry| *entry == 0.0) {
                    continue;
                }
                let weighted = weight * column;
                g[i] += weighted.dot(&r);
                for (j, other) in columns.column_iter().enumerate() {
                    f[(i, j)] += weighted.dot(&other);
                }
            }
        }
    }
    for (k, unknown) in unknowns.iter().enumerate() {
        f[(places.len() + k, places.len() + k)] += 1.0;
        g[places.len() + k] -= unknown;
    }
    let is_told = |k: usize| TERMS.iter().any(|term| term.tells(model, model.quantities[k], imu));
    let is_determined: Vec<bool> =
        (0..size).map(|i| f[(i, i)] > 0.0 && places.get(i).is_none_or(|&k| is_told(k))).collect();
    let determined = is_determined.iter().filter(|is| **is).count();
    let prior = model.prior.as_ref().map(|(_, weight)| {
        let of_prior = |i: usize| places.get(i).filter(|_| !is_determined[i]).map_or(0.0, |&k| weight[k]);
        DVector::from_fn(size, |i, _| of_prior(i))
    });
    Rest { information: f, rhs: g, determined, prior }
}

/// The weights that a state asks for.
pub(crate) fn reweigh(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &GravityResiduals,
) -> Result<RotationWeights> {
    let weighed = weigh_rotations(model, state, residuals, rest(&At { model, state, rotations: residuals }))
        .ok_or_else(singular)?;
    Ok(less_earth(weighed, model, state))
}

/// The same weights, with the step and the covariance of the present model.
pub(crate) fn with_same_weights(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &GravityResiduals,
    weighed: RotationWeights,
) -> Result<RotationWeights> {
    let weighed =
        solve_again(model, state, residuals, rest(&At { model, state, rotations: residuals }), weighed)
            .ok_or_else(singular)?;
    Ok(less_earth(weighed, model, state))
}

/// Turns `Γ` less what the Earth's rate makes of it into `Γ`.
fn less_earth(mut weighed: RotationWeights, model: &ImuModel<'_>, state: &State) -> RotationWeights {
    let places = model.gyroscope_places();
    for (i, &k) in places.iter().enumerate() {
        let taken = model.earth.taken_off(model.quantities[k], &state.imu);
        if taken != 0.0 {
            let first = places.len();
            weighed.step[i] -= taken * weighed.step[first];
            let row = weighed.covariance.row(first) * taken;
            weighed.covariance.row_mut(i).sub_assign(&row);
            let column = weighed.covariance.column(first) * taken;
            weighed.covariance.column_mut(i).sub_assign(&column);
        }
    }
    weighed
}
