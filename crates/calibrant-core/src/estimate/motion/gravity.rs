//! Takes gravity out of the bias of a solved problem, with its tilt marginalised.
//!
//! The chains are solved for the reading at rest `r = b + S (γ + o)` in the place of the bias
//! ([`gravity_marginal`](crate::information::GravityMarginal)). This holds for every trust, since a constant of
//! the specific force is a constant of the readings. Afterwards `b = r − S (γ + o)`, with the offset `o` at its
//! prior `N(0, P)`:
//!
//! `C_p = T C_q Tᵀ + J P Jᵀ`
//!
//! A datasheet prior of the biases speaks of `b` and not of `r`. So the chains leave it out, and it is an
//! observation of `(q, o)` afterwards, of which it corrects both (Kalman's update, linear at the estimated `S`).

use super::chain::Solved;
use super::context::Context;
use crate::estimate::RecoveredGravity;
use crate::information::gravity_marginal::{from_reading_at_rest, offset_response};
use crate::motion::MotionGravity;
use crate::sensor::Quantity;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Turns the readings at rest of a solved problem into biases.
pub(super) fn take_out(
    context: &Context<'_>,
    gravity: &MotionGravity,
    solved: &mut Solved,
) -> RecoveredGravity {
    let sensor = context.problem.sensor;
    let list = sensor.parameter_list();
    let p = list.len();
    // the matrix S of the axes that the sensor has
    let mut parameters = crate::sensor::SensorParameters::linear(Vector3::zeros(), Matrix3::zeros());
    for (quantity, value) in list.quantities().iter().zip(&solved.values) {
        quantity.add_to(&mut parameters, *value);
    }
    let response = offset_response(&list, &parameters.matrix);
    let of_both = |force: &Vector3<f64>| {
        let mut of = DMatrix::zeros(p, p + 3);
        of.columns_mut(0, p).copy_from(&from_reading_at_rest(&list, force));
        of.columns_mut(p, 3).copy_from(&(-&response));
        of
    };
    let mut both = DVector::zeros(p + 3);
    both.rows_mut(0, p).copy_from_slice(&solved.values);
    let mut covariance = DMatrix::zeros(p + 3, p + 3);
    covariance.view_mut((0, 0), (p, p)).copy_from(&solved.covariance);
    covariance.view_mut((p, p), (3, 3)).copy_from(&gravity.offset_covariance());

    let known: Vec<(usize, f64, f64)> = if context.settings.datasheet_prior {
        let described = sensor.nominal().map(|nominal| list.describe(sensor, &nominal)).unwrap_or_default();
        let is_bias = |k: usize| matches!(list.quantities()[k], Quantity::Bias(_));
        let entry = |(k, parameter): (usize, &crate::sensor::Parameter)| {
            Some((k, parameter.nominal.unwrap_or(0.0), parameter.spread?))
        };
        described.iter().enumerate().filter(|(k, _)| is_bias(*k)).filter_map(entry).collect()
    } else {
        Vec::new()
    };
    if !known.is_empty() {
        let places: Vec<usize> = known.iter().map(|(place, ..)| *place).collect();
        let observe = of_both(&gravity.force_mps2).select_rows(&places);
        let off =
            DVector::from_iterator(known.len(), known.iter().map(|(_, mean, _)| *mean)) - &observe * &both;
        let spread = DMatrix::from_diagonal(&DVector::from_iterator(
            known.len(),
            known.iter().map(|(.., spread)| spread * spread),
        ));
        let with = &covariance * observe.transpose();
        if let Some(factor) = (&observe * &with + spread).cholesky() {
            both += &with * factor.solve(&off);
            covariance -= &with * factor.solve(&with.transpose());
            solved.chi2 += off.dot(&factor.solve(&off));
        }
    }
    let offset = Vector3::new(both[p], both[p + 1], both[p + 2]);
    let of = of_both(&(gravity.force_mps2 + offset));
    // exact: bilinear in S and the offset, which the first p columns contain
    let values = of.columns(0, p) * both.rows(0, p);
    solved.values.copy_from_slice(values.as_slice());
    let biases = of.columns(0, p) * DVector::from_column_slice(&solved.bias);
    solved.bias.copy_from_slice(biases.as_slice());
    let joint = &of * &covariance * of.transpose();
    solved.covariance = (&joint + joint.transpose()) * 0.5;
    RecoveredGravity {
        gravity: *gravity,
        offset_mps2: offset,
        offset_covariance: Matrix3::from_fn(|i, j| covariance[(p + i, p + j)]),
    }
}
