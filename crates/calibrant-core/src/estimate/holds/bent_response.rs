//! An accelerometer whose response is bent by a term that was not estimated, or by another one than was.
//!
//! With `u` the direction of a hold, a term of coefficients `c` adds `Σ cᵢ uᵢ e(g uᵢ)` to the corrected magnitude. The parameters add `uᵢ` and `uᵢ uₖ`,
//! and take up a part of it as a bias. So one more least squares over the magnitudes, for each choice of terms, tells the `c`, how well the choice fits,
//! and how far the biases would move with it. Fisher's F tests the three `c` of a term together.
//!
//! A drift of the biases can look like a bent response, too: where the holds are enough it is fitted beside the terms, and freely.
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
/// Likelihood ratio beyond which the holds tell one term from another. The variance of the holds is estimated in each fit.
const TOLD_APART: f64 = 1000.0;

/// The finding, in a fit to the magnitude of gravity.
pub(super) fn bent_response(calibration: &Calibration, used: &[&HoldResult]) -> Option<Diagnostic> {
    let quantities = &calibration.quantities;
    let is_estimated = |term: &NonlinearTerm| {
        quantities.iter().any(|of| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(of, _)) if of == term))
    };
    let known: Vec<NonlinearTerm> = NonlinearTerm::ALL.into_iter().filter(is_estimated).collect();
    let magnitudes = Magnitudes::of(calibration, used, &known)?;
    finding(&known, |terms| magnitudes.fit(terms))
}

/// What fits with other terms than the ones that were estimated say of these.
pub(in crate::estimate) fn finding(
    known: &[NonlinearTerm],
    fit: impl Fn(&[NonlinearTerm]) -> Option<TermsFit>,
) -> Option<Diagnostic> {
    let now = fit(known)?;
    let missing: Vec<_> = NonlinearTerm::ALL.into_iter().filter(|term| !known.contains(term)).collect();
    let chance = CHANCE / missing.len().max(1) as f64;
    let more: Vec<(NonlinearTerm, TermsFit)> = missing
        .iter()
        .filter_map(|&term| {
            let with = fit(&[known, &[term]].concat())?;
            let p_value = f_p_value((now.chi2 - with.chi2) / with.variance(), 3, with.free)?;
            (p_value < chance && now.moved_sds(&with) > MATTERS).then_some((term, with))
        })
        .collect();
    if let Some((term, with)) = more.iter().min_by(|one, other| one.1.chi2.total_cmp(&other.1.chi2)) {
        let moved_sds = now.moved_sds(with);
        let is_told = more.iter().filter(|(_, other)| !with.is_told_from(other)).count() == 1;
        let of = Axis::ALL.map(|axis| (axis, with.coefficients[axis.index()]));
        let (axis, coefficient) =
            of.into_iter().max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
        return Some(match term {
            NonlinearTerm::GainBySign => {
                GainDependsOnSign { axis, difference: coefficient, moved_sds, is_told }.into()
            }
            NonlinearTerm::SecondOrder => {
                SecondOrderResponse { axis, second_order_per_mps2: coefficient, moved_sds, is_told }.into()
            }
        });
    }
    let [estimated] = known else { return None };
    let rivals = missing.iter().filter_map(|&rival| Some((rival, fit(&[rival])?)));
    let open = rivals.filter(|(_, with)| !now.is_told_from(with));
    let moved = open.map(|(rival, with)| (rival, now.moved_sds(&with)));
    let (rival, moved_sds) = moved.max_by(|one, other| one.1.total_cmp(&other.1))?;
    (moved_sds > MATTERS).then(|| ResponseTermOpen { estimated: *estimated, rival, moved_sds }.into())
}

/// A fit with a choice of terms.
pub(in crate::estimate) struct TermsFit {
    /// The biases in their standard deviations, from wherever.
    pub(in crate::estimate) biases: Vector3<f64>,
    /// Those of the last term.
    pub(in crate::estimate) coefficients: Vector3<f64>,
    pub(in crate::estimate) chi2: f64,
    /// Degrees of freedom.
    pub(in crate::estimate) free: f64,
}

impl TermsFit {
    fn variance(&self) -> f64 {
        self.chi2 / self.free
    }

    /// Is it far likelier than another fit with as many unknowns? The likelihoods go as `χ^−ν`.
    fn is_told_from(&self, other: &Self) -> bool {
        0.5 * self.free * (other.chi2 / self.chi2).ln() > TOLD_APART.ln()
    }

    /// How far a bias is most from that of another fit, in its standard deviations.
    fn moved_sds(&self, other: &Self) -> f64 {
        (self.biases - other.biases).amax()
    }
}

/// A hold with its weight.
struct Weighed {
    force_mps2: Vector3<f64>,
    weight: f64,
    /// The part of the drift that it has.
    of_drift: f64,
}

/// The magnitudes of the holds less gravity, as if no term had been estimated, in their standard deviations.
struct Magnitudes {
    holds: Vec<Weighed>,
    errors: DVector<f64>,
    has_cross_terms: bool,
    has_drift: bool,
    /// Standard deviations of the biases, m/s².
    bias_sd: Vector3<f64>,
}

impl Magnitudes {
    fn of(calibration: &Calibration, used: &[&HoldResult], known: &[NonlinearTerm]) -> Option<Self> {
        let (of_holds, sensor) = (calibration.holds()?, &calibration.imu[SensorKind::Accelerometer]);
        let gains = sensor.gains();
        let weigh = |hold: &&HoldResult| {
            let u = hold.force_mps2.normalize();
            let within = hold.hold.sd.component_div(&gains).component_mul(&u).norm()
                / (hold.hold.samples() as f64).sqrt();
            within.hypot(of_holds.between_holds_sd_mps2).max(f64::MIN_POSITIVE).recip()
        };
        let part = |hold: &HoldResult| of_holds.drift.as_ref().map_or(0.0, |drift| drift.part_of(&hold.hold));
        let weighed = |hold: &&HoldResult| Weighed {
            force_mps2: hold.force_mps2,
            weight: weigh(hold),
            of_drift: part(hold),
        };
        let holds: Vec<Weighed> = used.iter().map(weighed).collect();
        let taken = |force: &Vector3<f64>| {
            let of = |term: &NonlinearTerm| effect(*term, force).dot(sensor.nonlinearity.of(*term));
            known.iter().map(of).sum::<f64>()
        };
        let errors = used
            .iter()
            .zip(&holds)
            .map(|(hold, of)| (hold.magnitude_residual_mps2 + taken(&of.force_mps2)) * of.weight);
        let (sd, bias) =
            (calibration.sd(), |axis| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)));
        let place = |axis: Axis| calibration.quantities.iter().position(|of| *of == bias(axis));
        let bias_sd =
            Axis::ALL.map(|axis| place(axis).map_or(f64::INFINITY, |k| sd[k] / gains[axis.index()]));
        let has_cross_terms = calibration
            .quantities
            .iter()
            .any(|of| matches!(of, ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..))));
        // for one more term
        let unknowns = 3 + if has_cross_terms { 6 } else { 3 } + 3 * known.len() + 3;
        Some(Self {
            errors: DVector::from_iterator(used.len(), errors),
            has_drift: of_holds.drift.is_some() && used.len() >= unknowns + 3 + FEWEST,
            holds,
            has_cross_terms,
            bias_sd: Vector3::from(bias_sd),
        })
    }

    /// The least squares with these terms. `None` of too few holds.
    fn fit(&self, terms: &[NonlinearTerm]) -> Option<TermsFit> {
        let products: &[(usize, usize)] = match self.has_cross_terms {
            true => &[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
            false => &[(0, 0), (1, 1), (2, 2)],
        };
        let drift = if self.has_drift { 3 } else { 0 };
        let unknowns = 3 + products.len() + drift + 3 * terms.len();
        if self.holds.len() < unknowns + FEWEST {
            return None;
        }
        let mut rows = DMatrix::zeros(self.holds.len(), unknowns);
        for (j, Weighed { force_mps2: force, weight, of_drift }) in self.holds.iter().enumerate() {
            let u = force.normalize();
            let parameters = (0..3).map(|axis| u[axis]).chain(products.iter().map(|&(i, k)| u[i] * u[k]));
            let of_terms = terms.iter().flat_map(|&term| <[f64; 3]>::from(effect(term, force)));
            let of_drift = (0..drift).map(|axis| u[axis] * of_drift);
            parameters
                .chain(of_drift)
                .chain(of_terms)
                .enumerate()
                .for_each(|(column, value)| rows[(j, column)] = weight * value);
        }
        let solved = (rows.transpose() * &rows).cholesky()?.solve(&(rows.transpose() * &self.errors));
        let chi2 = (&self.errors - &rows * &solved).norm_squared();
        Some(TermsFit {
            biases: Vector3::from_fn(|axis, _| solved[axis] / self.bias_sd[axis]),
            coefficients: solved.fixed_rows::<3>(unknowns - 3).into_owned(),
            chi2,
            free: (self.holds.len() - unknowns) as f64,
        })
    }
}

/// What a coefficient of 1 on each axis adds to the magnitude, m/s².
fn effect(term: NonlinearTerm, force: &Vector3<f64>) -> Vector3<f64> {
    let u = force.normalize();
    Vector3::from_fn(|axis, _| u[axis] * term.value(force[axis]))
}
