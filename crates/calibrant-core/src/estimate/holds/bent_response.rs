//! An accelerometer whose response is bent by a term that was not estimated, or by another one than was.
//!
//! With `u` the direction of a hold, a term of coefficients `c` adds `Σ cᵢ uᵢ e(g uᵢ)` to the corrected magnitude. The parameters add `uᵢ` and `uᵢ uₖ`,
//! and take up a part of it as a bias. So one more least squares over the magnitudes, for each choice of terms, tells the `c`, how well the choice fits,
//! and how far the biases would move with it. Fisher's F tests the three `c` of a term together.
//!
//! Terms look alike: `u³` and `u |u|` differ by a few per cent of themselves. Two that fit equally well give other biases, and only both together are safe.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::{GainDependsOnSign, ResponseTermOpen, SecondOrderResponse};
use crate::estimate::{Calibration, HoldResult};
use crate::sensor::{Axis, ImuQuantity, NonlinearTerm, Quantity, SensorKind};
use crate::solve::f_p_value;
use nalgebra::{DMatrix, DVector, Vector3};

/// Probability of coefficients at least this large of any term in a sensor of linear response.
const CHANCE: f64 = 1e-3;
/// Movement of a bias in its standard deviations that matters.
const MATTERS: f64 = 2.0;
/// Fewest degrees of freedom that tell a variance.
const FEWEST: usize = 5;
/// Two choices of terms are told apart where their χ² differ by more: one is then 90 times as likely as the other.
const TOLD_APART: f64 = 9.0;

/// The finding, in a fit to the magnitude of gravity.
pub(super) fn bent_response(calibration: &Calibration, used: &[&HoldResult]) -> Option<Diagnostic> {
    let quantities = &calibration.quantities;
    let is_estimated = |term: &NonlinearTerm| {
        quantities.iter().any(|of| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(of, _)) if of == term))
    };
    let (known, missing): (Vec<_>, Vec<_>) = NonlinearTerm::ALL.into_iter().partition(is_estimated);
    let magnitudes = Magnitudes::of(calibration, used, &known)?;
    let now = magnitudes.fit(&known)?;
    let chance = CHANCE / missing.len().max(1) as f64;
    let more: Vec<(NonlinearTerm, Fit)> = missing
        .iter()
        .filter_map(|&term| {
            let with = magnitudes.fit(&[known.as_slice(), &[term]].concat())?;
            let p_value = f_p_value((now.chi2 - with.chi2) / with.variance(), 3, with.free)?;
            (p_value < chance && magnitudes.moved_sds(&now, &with) > MATTERS).then_some((term, with))
        })
        .collect();
    if let Some((term, with)) = more.iter().min_by(|one, other| one.1.chi2.total_cmp(&other.1.chi2)) {
        let moved_sds = magnitudes.moved_sds(&now, with);
        let as_good = |other: &Fit| other.chi2 - with.chi2 < TOLD_APART * with.variance();
        let is_told = more.iter().filter(|(_, other)| as_good(other)).count() == 1;
        let (axis, coefficient) = with.largest();
        return Some(match term {
            NonlinearTerm::GainBySign => {
                GainDependsOnSign { axis, difference: coefficient, moved_sds, is_told }.into()
            }
            NonlinearTerm::SecondOrder => {
                SecondOrderResponse { axis, second_order_per_mps2: coefficient, moved_sds, is_told }.into()
            }
        });
    }
    let [estimated] = known.as_slice() else { return None };
    let rivals = missing.iter().filter_map(|&rival| Some((rival, magnitudes.fit(&[rival])?)));
    let open = rivals.filter(|(_, with)| with.chi2 - now.chi2 < TOLD_APART * now.variance());
    let moved = open.map(|(rival, with)| (rival, magnitudes.moved_sds(&now, &with)));
    let (rival, moved_sds) = moved.max_by(|one, other| one.1.total_cmp(&other.1))?;
    (moved_sds > MATTERS).then(|| ResponseTermOpen { estimated: *estimated, rival, moved_sds }.into())
}

/// The magnitudes of the holds less gravity, as if no term had been estimated, in their standard deviations.
struct Magnitudes {
    /// Force along each axis, m/s², and the weight.
    holds: Vec<(Vector3<f64>, f64)>,
    errors: DVector<f64>,
    has_cross_terms: bool,
    /// Standard deviations of the biases, m/s².
    bias_sd: Vector3<f64>,
}

impl Magnitudes {
    fn of(calibration: &Calibration, used: &[&HoldResult], known: &[NonlinearTerm]) -> Option<Self> {
        let (of_holds, sensor) = (calibration.holds()?, &calibration.imu.accelerometer);
        let gains = Vector3::from_fn(|axis, _| sensor.matrix.row(axis).norm());
        let weigh = |hold: &&HoldResult| {
            let u = hold.force_mps2.normalize();
            let within = hold.hold.sd.component_div(&gains).component_mul(&u).norm()
                / (hold.hold.samples() as f64).sqrt();
            within.hypot(of_holds.between_holds_sd_mps2).max(f64::MIN_POSITIVE).recip()
        };
        let holds: Vec<_> = used.iter().map(|hold| (hold.force_mps2, weigh(hold))).collect();
        let taken = |force: &Vector3<f64>| {
            let of = |term: &NonlinearTerm| effect(*term, force).dot(sensor.nonlinearity.of(*term));
            known.iter().map(of).sum::<f64>()
        };
        let errors = used
            .iter()
            .zip(&holds)
            .map(|(hold, (force, weight))| (hold.magnitude_residual_mps2 + taken(force)) * weight);
        let (sd, bias) =
            (calibration.sd(), |axis| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)));
        let place = |axis: Axis| calibration.quantities.iter().position(|of| *of == bias(axis));
        let bias_sd =
            Axis::ALL.map(|axis| place(axis).map_or(f64::INFINITY, |k| sd[k] / gains[axis.index()]));
        let has_cross_terms = calibration
            .quantities
            .iter()
            .any(|of| matches!(of, ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..))));
        Some(Self {
            errors: DVector::from_iterator(used.len(), errors),
            holds,
            has_cross_terms,
            bias_sd: Vector3::from(bias_sd),
        })
    }

    /// The least squares with these terms. `None` of too few holds.
    fn fit(&self, terms: &[NonlinearTerm]) -> Option<Fit> {
        let products: &[(usize, usize)] = match self.has_cross_terms {
            true => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
            false => &[(0, 0), (1, 1), (2, 2)],
        };
        let unknowns = 3 + products.len() + 3 * terms.len();
        if self.holds.len() < unknowns + FEWEST {
            return None;
        }
        let mut rows = DMatrix::zeros(self.holds.len(), unknowns);
        for (j, (force, weight)) in self.holds.iter().enumerate() {
            let u = force.normalize();
            let parameters = (0..3).map(|axis| u[axis]).chain(products.iter().map(|&(i, k)| u[i] * u[k]));
            let of_terms = terms.iter().flat_map(|&term| <[f64; 3]>::from(effect(term, force)));
            parameters
                .chain(of_terms)
                .enumerate()
                .for_each(|(column, value)| rows[(j, column)] = weight * value);
        }
        let solved = (rows.transpose() * &rows).cholesky()?.solve(&(rows.transpose() * &self.errors));
        let chi2 = (&self.errors - &rows * &solved).norm_squared();
        Some(Fit { solved, chi2, free: (self.holds.len() - unknowns) as f64 })
    }

    /// How far a bias moves most from one fit to another, in its standard deviations.
    fn moved_sds(&self, one: &Fit, other: &Fit) -> f64 {
        (0..3).map(|k| ((one.solved[k] - other.solved[k]) / self.bias_sd[k]).abs()).fold(0.0, f64::max)
    }
}

/// What a coefficient of 1 on each axis adds to the magnitude, m/s².
fn effect(term: NonlinearTerm, force: &Vector3<f64>) -> Vector3<f64> {
    let u = force.normalize();
    Vector3::from_fn(|axis, _| u[axis] * term.value(force[axis]))
}

struct Fit {
    /// Those of `u`, of the products, and of the terms, three each.
    solved: DVector<f64>,
    chi2: f64,
    free: f64,
}

impl Fit {
    /// χ² over the degrees of freedom.
    fn variance(&self) -> f64 {
        self.chi2 / self.free
    }

    /// The largest coefficient of the last term, and its axis.
    fn largest(&self) -> (Axis, f64) {
        let first = self.solved.len() - 3;
        let of = Axis::ALL.map(|axis| (axis, self.solved[first + axis.index()]));
        of.into_iter().max_by(|one, other| one.1.abs().total_cmp(&other.1.abs())).unwrap_or(of[0])
    }
}
