//! An accelerometer whose gain for positive forces is another than that for negative ones.
//!
//! With `u` the direction of a hold, such a gain adds `g Σ κᵢ uᵢ|uᵢ|` to its magnitude. The parameters add `uᵢ` and `uᵢ uₖ`, and take up a part of it as a bias.
//! One more least squares over the residuals of the magnitudes tells the `κ`, and how far the biases would move with them. Fisher's F tests all `κ` together.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::GainDependsOnSign;
use crate::estimate::statistics::f_p_value;
use crate::estimate::{Calibration, HoldResult};
use crate::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use nalgebra::{DMatrix, DVector, Vector3};

/// Probability of `κ` at least this large in a sensor of constant gains.
const CHANCE: f64 = 1e-3;
/// Movement of a bias in its standard deviations that matters.
const MATTERS: f64 = 2.0;
/// Fewest degrees of freedom that tell a variance.
const FEWEST: usize = 5;

/// The finding, in a fit to the magnitude of gravity.
pub(super) fn sign_dependence(calibration: &Calibration, used: &[&HoldResult]) -> Option<Diagnostic> {
    let holds = calibration.holds()?;
    let matrix = &calibration.imu.accelerometer.matrix;
    let is_cross_term = |of: &ImuQuantity| {
        matches!(of, ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..)))
    };
    let has_cross_terms = calibration.quantities.iter().any(is_cross_term);
    let products: &[(usize, usize)] = match has_cross_terms {
        true => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
        false => &[(0, 0), (1, 1), (2, 2)],
    };
    let unknowns = 3 + products.len() + 3;
    if used.len() < unknowns + FEWEST {
        return None;
    }
    let gains = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
    let (mut rows, mut errors) = (DMatrix::zeros(used.len(), unknowns), DVector::zeros(used.len()));
    for (j, hold) in used.iter().enumerate() {
        let u = hold.force_mps2.normalize();
        let within =
            hold.hold.sd.component_div(&gains).component_mul(&u).norm() / (hold.hold.samples() as f64).sqrt();
        let weight = within.hypot(holds.between_holds_sd_mps2).max(f64::MIN_POSITIVE).recip();
        let parameters = (0..3).map(|axis| u[axis]).chain(products.iter().map(|&(i, k)| u[i] * u[k]));
        let all = parameters.chain((0..3).map(|axis| u[axis] * u[axis].abs()));
        all.enumerate().for_each(|(column, value)| rows[(j, column)] = weight * value);
        errors[j] = weight * hold.magnitude_residual_mps2;
    }
    let inverse = (rows.transpose() * &rows).cholesky()?.inverse();
    let solved = &inverse * rows.transpose() * &errors;
    let left = (&errors - &rows * &solved).norm_squared();
    let free = (used.len() - unknowns) as f64;
    let kappa = solved.fixed_rows::<3>(unknowns - 3).into_owned();
    let of_kappa = inverse.fixed_view::<3, 3>(unknowns - 3, unknowns - 3).into_owned();
    let chi2 = kappa.dot(&of_kappa.cholesky()?.solve(&kappa)) / (left / free);
    let sd = calibration.sd();
    let moved_sds = Axis::ALL.into_iter().filter_map(|axis| {
        let bias = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis));
        let place = calibration.quantities.iter().position(|of| *of == bias)?;
        Some((solved[axis.index()] * gains[axis.index()] / sd[place]).abs())
    });
    let moved_sds = moved_sds.fold(0.0, f64::max);
    let is_found = f_p_value(chi2, 3, free)? < CHANCE && moved_sds > MATTERS;
    let axis = Axis::ALL
        .into_iter()
        .max_by(|one, other| kappa[one.index()].abs().total_cmp(&kappa[other.index()].abs()))?;
    let difference = 2.0 * kappa[axis.index()] / holds.gravity.magnitude_mps2;
    is_found.then(|| GainDependsOnSign { axis, difference, moved_sds }.into())
}
