//! The gyroscope's parameters and the Earth's rate as a linear problem, directions fixed: the rest of it beside the rotations, and the weights of these.

use crate::error::Result;
use crate::estimate::imu::model::{GravityResiduals, ImuModel, State, TurnData, singular};
use crate::estimate::imu::variance_components::rotations::{
    Rest, RotationWeights, solve_again, weigh_rotations,
};
use crate::sensor::{Condition, ImuParameters, ImuQuantity};
use nalgebra::{DMatrix, DVector, Matrix3xX, Vector3};
use std::ops::SubAssign;

/// What holds, turns and prior say of the gyroscope and the Earth's rate, directions fixed: the rest of the problem beside the rotations. In place of `Γ` stands what [`EarthRate`](crate::estimate::imu::earth_rate) makes of it.
fn rest(model: &ImuModel<'_>, state: &State) -> Rest {
    let places = model.gyroscope_places();
    let unknowns = model.earth.unknowns();
    let size = places.len() + unknowns.len();
    let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let imu = &state.imu;
    let mut add =
        |at: Condition<'_>, time: f64, r: Vector3<f64>, weight: &Vector3<f64>, of_earth: Matrix3xX<f64>| {
            let columns: Vec<Vector3<f64>> = places
                .iter()
                .map(|&k| {
                    let quantity = model.quantities[k];
                    let scale = if quantity.is_of_bias() { time } else { 1.0 };
                    quantity.derivative(&at) * scale
                })
                .chain(of_earth.column_iter().map(|column| column.into_owned()))
                .collect();
            for i in 0..size {
                let weighted = columns[i].component_mul(weight);
                g[i] += weighted.dot(&r);
                for j in 0..size {
                    f[(i, j)] += weighted.dot(&columns[j]);
                }
            }
        };
    for (j, (hold, force)) in model.holds.iter().zip(&state.forces).enumerate() {
        if let Some((mean, weight)) = &hold.gyroscope {
            let temperature_c = hold.temperature_c;
            let still = Condition { imu, stimulus: model.earth.rate(j, force), force: *force, temperature_c };
            let here = imu.at(temperature_c);
            let residual = mean - model.at_rest(j, &here, force);
            add(still, 1.0, residual, weight, model.earth.of_hold(j, &here, force));
        }
    }
    for turn in &model.turns {
        let (stimulus, force, temperature_c) = (model.turned(turn), turn.force, turn.temperature_c);
        let at = Condition { imu, stimulus, force, temperature_c };
        let of_earth = model.earth.of_turn(&imu.at(temperature_c), &force);
        add(at, turn.duration_s, model.turn_residual(turn, imu), &turn.weight, of_earth);
    }
    if let Some((mean, weight)) = &model.prior {
        for (i, &k) in places.iter().enumerate() {
            let (off, taken) =
                (mean[k] - model.quantities[k].value(imu), model.earth.taken_off(model.quantities[k], imu));
            f[(i, i)] += weight[k];
            g[i] += weight[k] * off;
            if taken != 0.0 {
                let first = places.len();
                f[(i, first)] -= weight[k] * taken;
                f[(first, i)] -= weight[k] * taken;
                f[(first, first)] += weight[k] * taken * taken;
                g[first] -= weight[k] * off * taken;
            }
        }
    }
    for (k, unknown) in unknowns.iter().enumerate() {
        f[(places.len() + k, places.len() + k)] += 1.0;
        g[places.len() + k] -= unknown;
    }
    let is_determined: Vec<bool> = (0..size)
        .map(|i| f[(i, i)] > 0.0 && places.get(i).is_none_or(|&k| is_reported(model, k, imu)))
        .collect();
    let determined = is_determined.iter().filter(|is| **is).count();
    let prior = model.prior.as_ref().map(|(_, weight)| {
        let of_prior = |i: usize| places.get(i).filter(|_| !is_determined[i]).map_or(0.0, |&k| weight[k]);
        DVector::from_fn(size, |i, _| of_prior(i))
    });
    Rest { information: f, rhs: g, determined, prior }
}

/// Do the data beside the rotations tell a quantity? What the Earth's rate in the holds says of gains is nothing beside these.
fn is_reported(model: &ImuModel<'_>, place: usize, imu: &ImuParameters) -> bool {
    let quantity = model.quantities[place];
    let of_turn = |turn: &TurnData| {
        let (force, temperature_c) = (turn.force, turn.temperature_c);
        quantity.derivative(&Condition { imu, stimulus: turn.angle, force, temperature_c }).amax() > 0.0
    };
    quantity.is_of_bias()
        || matches!(quantity, ImuQuantity::GSensitivity(..))
        || model.turns.iter().any(of_turn)
}

/// The weights that a state asks for.
pub(crate) fn reweigh(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &GravityResiduals,
) -> Result<RotationWeights> {
    let weighed = weigh_rotations(model, state, residuals, rest(model, state)).ok_or_else(singular)?;
    Ok(less_earth(weighed, model, state))
}

/// The same weights, with the step and the covariance of the present model.
pub(crate) fn with_same_weights(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &GravityResiduals,
    weighed: RotationWeights,
) -> Result<RotationWeights> {
    let weighed = solve_again(model, state, residuals, rest(model, state), weighed).ok_or_else(singular)?;
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
