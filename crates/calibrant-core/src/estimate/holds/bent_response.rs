//! An accelerometer whose response is bent by a term that was not estimated.
//!
//! With `u` the direction of a hold, a term of coefficients `c` adds `Σ cᵢ uᵢ e(g uᵢ)` to the corrected magnitude. The parameters add `uᵢ` and `uᵢ uₖ`,
//! and take up a part of it as a bias. One more least squares over the residuals of the magnitudes tells the `c`, and how far the biases would move with
//! them. Fisher's F tests the three `c` of a term together; of the terms that it finds the one that fits best is named.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::{GainDependsOnSign, SecondOrderResponse};
use crate::estimate::statistics::f_p_value;
use crate::estimate::{Calibration, HoldResult};
use crate::sensor::{Axis, ImuQuantity, NonlinearTerm, Quantity, SensorKind};
use nalgebra::{DMatrix, DVector, Vector3};

/// Probability of coefficients at least this large of any term in a sensor of linear response.
const CHANCE: f64 = 1e-3;
/// Movement of a bias in its standard deviations that matters.
const MATTERS: f64 = 2.0;
/// Fewest degrees of freedom that tell a variance.
const FEWEST: usize = 5;

/// The finding, in a fit to the magnitude of gravity.
pub(super) fn bent_response(calibration: &Calibration, used: &[&HoldResult]) -> Option<Diagnostic> {
    let quantities = &calibration.quantities;
    let estimated = |term: NonlinearTerm| {
        quantities
            .iter()
            .any(|of| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(of, _)) if *of == term))
    };
    let (known, missing): (Vec<_>, Vec<_>) =
        NonlinearTerm::ALL.into_iter().partition(|term| estimated(*term));
    let chance = CHANCE / missing.len().max(1) as f64;
    let tested = missing.iter().filter_map(|&term| Bent::of(calibration, used, &known, term));
    let found = tested.filter(|of| of.p_value < chance && of.moved_sds > MATTERS);
    let Bent { term, coefficients, moved_sds, .. } =
        found.min_by(|one, other| one.left.total_cmp(&other.left))?;
    let largest = |one: &Axis, other: &Axis| {
        coefficients[one.index()].abs().total_cmp(&coefficients[other.index()].abs())
    };
    let axis = Axis::ALL.into_iter().max_by(largest)?;
    let coefficient = coefficients[axis.index()];
    Some(match term {
        NonlinearTerm::GainBySign => GainDependsOnSign { axis, difference: coefficient, moved_sds }.into(),
        NonlinearTerm::SecondOrder => {
            SecondOrderResponse { axis, second_order_per_mps2: coefficient, moved_sds }.into()
        }
    })
}

/// What the holds say of a term.
struct Bent {
    term: NonlinearTerm,
    /// Of each axis.
    coefficients: Vector3<f64>,
    /// Of coefficients this large by chance.
    p_value: f64,
    /// Most that a bias would move, in its standard deviations.
    moved_sds: f64,
    /// χ² that is left.
    left: f64,
}

impl Bent {
    /// `known`: the terms that were estimated.
    fn of(
        calibration: &Calibration,
        used: &[&HoldResult],
        known: &[NonlinearTerm],
        term: NonlinearTerm,
    ) -> Option<Self> {
        let holds = calibration.holds()?;
        let is_cross_term = |of: &ImuQuantity| {
            matches!(of, ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..)))
        };
        let has_cross_terms = calibration.quantities.iter().any(is_cross_term);
        let products: &[(usize, usize)] = match has_cross_terms {
            true => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
            false => &[(0, 0), (1, 1), (2, 2)],
        };
        let unknowns = 3 + products.len() + 3 * known.len() + 3;
        if used.len() < unknowns + FEWEST {
            return None;
        }
        let gravity = holds.gravity.magnitude_mps2;
        let gains = Vector3::from_fn(|axis, _| calibration.imu.accelerometer.matrix.row(axis).norm());
        let (mut rows, mut errors) = (DMatrix::zeros(used.len(), unknowns), DVector::zeros(used.len()));
        for (j, hold) in used.iter().enumerate() {
            let u = hold.force_mps2.normalize();
            let within = hold.hold.sd.component_div(&gains).component_mul(&u).norm()
                / (hold.hold.samples() as f64).sqrt();
            let weight = within.hypot(holds.between_holds_sd_mps2).max(f64::MIN_POSITIVE).recip();
            let parameters = (0..3).map(|axis| u[axis]).chain(products.iter().map(|&(i, k)| u[i] * u[k]));
            let of_term = |term: &NonlinearTerm| {
                let term = *term;
                (0..3).map(move |axis| u[axis] * term.value(gravity * u[axis]))
            };
            let all = parameters.chain(known.iter().chain([&term]).flat_map(of_term));
            all.enumerate().for_each(|(column, value)| rows[(j, column)] = weight * value);
            errors[j] = weight * hold.magnitude_residual_mps2;
        }
        let inverse = (rows.transpose() * &rows).cholesky()?.inverse();
        let solved = &inverse * rows.transpose() * &errors;
        let left = (&errors - &rows * &solved).norm_squared();
        let free = (used.len() - unknowns) as f64;
        let coefficients = solved.fixed_rows::<3>(unknowns - 3).into_owned();
        let covariance = inverse.fixed_view::<3, 3>(unknowns - 3, unknowns - 3).into_owned();
        let chi2 = coefficients.dot(&covariance.cholesky()?.solve(&coefficients)) / (left / free);
        let sd = calibration.sd();
        let moved_sds = Axis::ALL.into_iter().filter_map(|axis| {
            let bias = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis));
            let place = calibration.quantities.iter().position(|of| *of == bias)?;
            Some((solved[axis.index()] * gains[axis.index()] / sd[place]).abs())
        });
        let moved_sds = moved_sds.fold(0.0, f64::max);
        Some(Self { term, coefficients, p_value: f_p_value(chi2, 3, free)?, moved_sds, left })
    }
}
