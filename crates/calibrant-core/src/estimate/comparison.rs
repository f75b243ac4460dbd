//! Comparison of two calibrations of one sensor, whatever their conventions.
//!
//! The comparison has two parts. Single quantities are compared by their frame invariants ([`Invariant`]). All parameters together are compared in
//! one frame, the lower gauge of one sensor: `χ² = dᵀ (Σ_A + Σ_B)⁺ d`, with `d` their difference. This includes all parameters of either covariance.
//! It assumes different recordings. For the same recording, `χ²` is too small.
//!
//! At one place the two have errors in common: gravity that is not exactly known, the geometry of a machine ([`SharedErrors`](crate::sensor::SharedErrors)).
//! With `Σ_A = R_A + U_A U_Aᵀ` the covariance of the difference is then `R_A + R_B + (U_A − U_B)(U_A − U_B)ᵀ`: what both share does not hide a change.
//!
//! A covariance that comes from a scatter of few residuals is itself uncertain ([`CovarianceDegrees`](crate::sensor::CovarianceDegrees)). A difference then follows Student's t, and χ²/n
//! Fisher's F. The degrees of freedom of a sum of variances are those of Welch and Satterthwaite (`gum`).
//! The parts of an IMU have scatters of their own, and each adds the χ² of its own probability.
//!
//! If both have temperature terms, B is first converted to the reference temperature of A. If only one has, it is taken at its own reference.

mod place;

pub use place::Place;

use super::effective_degrees;
use super::gravity_error::tells_its_place;
use crate::diagnostic::comparison::{
    ComparedAtTemperature, NotBroughtTogether, NotInBoth, PlaceUnknown, RecordingsSupposed,
    SignificanceUncertain, UnitsApart, UnknownUncertainty,
};
use crate::diagnostic::{Diagnostic, Phrase};
use crate::error::Error;
use crate::form::{As, finite};
use crate::json::if_some;
use crate::sensor::{
    CalibratedImu, CovariancePart, Gauge, ImuQuantity, Invariant, InvariantValue, Quantity, SensorKind,
};
use crate::solve::{chi2_of_p_value, chi2_p_value, f_p_value};
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

/// Two calibrations side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The invariants that both have, in the order of a table.
    pub quantities: Vec<ComparedQuantity>,
    /// All parameters together; `None` without a covariance (see [`notes`](Comparison::notes)).
    pub overall: Option<OverallDifference>,
    /// The same if both were made at one place; `None` where it is known whether they were, or where they share no error.
    pub overall_at_one_place: Option<OverallDifference>,
    /// What could not be compared, and what the comparison assumes.
    pub notes: Vec<Diagnostic>,
}

impl Place {
    /// The same, where a source of errors that both state tells its place by itself.
    fn told_by(self, sources: &[Matched]) -> Self {
        let told = sources.iter().any(|(source, ..)| tells_its_place(source));
        if self == Self::Unknown && told { Self::One } else { self }
    }
}

/// One invariant in two calibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedQuantity {
    /// Which one.
    pub invariant: Invariant,
    /// Its unit in the first calibration.
    pub unit_a: &'static str,
    /// Its unit in the second.
    pub unit_b: &'static str,
    /// In the first.
    pub a: InvariantValue,
    /// In the second.
    pub b: InvariantValue,
    /// Second minus first; `None` where the units differ.
    pub difference: Option<f64>,
    /// Joint standard deviation; a calibration without a covariance counts as exact. `None` where neither has one.
    pub sd: Option<f64>,
    /// The difference in joint standard deviations.
    pub in_sd: Option<f64>,
    /// Degrees of freedom behind the joint standard deviation.
    pub degrees_of_freedom: f64,
    /// Probability of a larger difference, by Student's t, if both are calibrations of one sensor.
    pub p_value: Option<f64>,
}

crate::json_object! {
    /// Two calibrations side by side.
    Comparison as comparison {
        /// The invariants that both have.
        quantities: &comparison.quantities,
        /// All parameters together; none without a covariance.
        overall: comparison.overall,
        /// The same if both were made at one place, where that is not known and they share errors.
        overall_at_one_place: if_some(comparison.overall_at_one_place),
        /// What could not be compared, and what the comparison assumes.
        notes: &comparison.notes,
    }
}

crate::json_object! {
    /// One invariant in two calibrations.
    ComparedQuantity as row {
        /// What is compared.
        name: row.invariant,
        /// Its unit; where they differ, that of A, a bar, and that of B.
        unit: row.unit(),
        /// The value in the first calibration.
        a: row.a.value,
        /// Its standard deviation; unknown without a covariance.
        a_sd: row.a.sd,
        /// The value in the second calibration.
        b: row.b.value,
        /// Its standard deviation; unknown without a covariance.
        b_sd: row.b.sd,
        /// Second minus first; none where the units differ.
        difference: row.difference,
        /// Joint standard deviation of both.
        difference_sd: row.sd,
        difference_in_sd: row.in_sd,
        /// None where the sd is known.
        degrees_of_freedom: finite(row.degrees_of_freedom),
        /// Probability of a larger difference if both are of one sensor.
        p_value: row.p_value,
    }
}

impl ComparedQuantity {
    fn unit(&self) -> String {
        if self.unit_a == self.unit_b {
            self.unit_a.into()
        } else {
            format!("{} | {}", self.unit_a, self.unit_b)
        }
    }
}

/// Difference of all parameters together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct OverallDifference {
    /// `dᵀ (Σ_A + Σ_B)⁺ d`.
    pub chi2: f64,
    /// Rank of `Σ_A + Σ_B`.
    pub degrees_of_freedom: usize,
    /// The least degrees of freedom behind a part of `Σ_A + Σ_B`.
    #[serde(with = "As::<Option<f64>>")]
    pub degrees_behind: f64,
    /// Probability of a larger difference, by Fisher's F, if both are calibrations of one sensor.
    pub p_value: f64,
}

impl Comparison {
    /// Compares two calibrations of which it is not known whether they were made at one place ([`at`](Self::at)).
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::estimate::Comparison;
    /// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ImuQuantity, ReadingUnit, SensorKind};
    /// use nalgebra::DMatrix;
    /// let quantities = ImuQuantity::full_list(true, false, false)[..6].to_vec(); // bias and scale factors
    /// let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
    /// let mut a = CalibratedImu::new(ImuParameters::identity(), units, quantities, "");
    /// a.covariance = Some(DMatrix::identity(6, 6) * 1e-6);
    /// let mut b = a.clone();
    /// b.parameters[SensorKind::Accelerometer].bias.x = 0.004;
    /// let comparison = Comparison::of(&a, &b);
    /// assert!((comparison.quantities[0].in_sd.unwrap() - 4.0 / 2f64.sqrt()).abs() < 1e-9);
    /// assert!((comparison.overall.unwrap().chi2 - 8.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn of(a: &CalibratedImu, b: &CalibratedImu) -> Self {
        Self::at(Place::Unknown, a, b)
    }

    /// Compares two calibrations. Where they were made at one place, the errors that both share do not count. Where that is not known they count as
    /// those of two places, and a note says what they would be at one.
    #[must_use]
    pub fn at(place: Place, a: &CalibratedImu, b: &CalibratedImu) -> Self {
        let mut notes: Vec<Diagnostic> = Vec::new();
        for sensor_kind in SensorKind::ALL {
            let mut lacks =
                |lacking, has_gains| notes.push(NotInBoth { lacking, sensor_kind, has_gains }.into());
            match (a.unit(sensor_kind), b.unit(sensor_kind)) {
                (Some(unit_a), Some(unit_b)) if unit_a != unit_b => {
                    notes.push(UnitsApart { sensor_kind, unit_a, unit_b }.into());
                }
                (Some(_), None) => lacks("B", false),
                (None, Some(_)) => lacks("A", false),
                (Some(_), Some(_)) => {
                    let without =
                        [("A", a), ("B", b)].into_iter().filter(|(_, imu)| !imu.has_bias(sensor_kind));
                    without.for_each(|(name, _)| lacks(name, true));
                }
                (None, None) => {}
            }
        }
        let (a, b) = &brought_together(a, b, &mut notes);
        let matched = matched(a, b);
        let place = place.told_by(&matched);
        let common = if place == Place::One { matched.clone() } else { Vec::new() };
        let of_b = b.invariants();
        let quantities: Vec<_> = a
            .invariants()
            .into_iter()
            .filter_map(|in_a| Some((in_a, *of_b.iter().find(|in_b| in_b.invariant == in_a.invariant)?)))
            .map(|(in_a, in_b)| compared(a, b, in_a, in_b, &common))
            .collect();
        let without = |of| SignificanceUncertain { of, unknown: UnknownUncertainty::Covariance }.into();
        notes.push(match (&a.covariance, &b.covariance) {
            (None, None) => without(None),
            (Some(_), None) => without(Some("B")),
            (None, Some(_)) => without(Some("A")),
            (Some(_), Some(_)) => RecordingsSupposed {}.into(),
        });
        notes.extend([("A", a), ("B", b)].into_iter().filter_map(|(name, imu)| about_degrees(name, imu)));
        let overall = difference(a, b, &common, &mut notes);
        let unknown = place == Place::Unknown && !matched.is_empty();
        let overall_at_one_place =
            overall.filter(|_| unknown).and_then(|_| difference(a, b, &matched, &mut Vec::new()));
        if let Some((apart, together)) = overall.zip(overall_at_one_place) {
            let sources = matched.into_iter().map(|(source, ..)| source).collect();
            notes.push(
                PlaceUnknown { sources, p_value: apart.p_value, p_value_at_one: together.p_value }.into(),
            );
        }
        Self { quantities, overall, overall_at_one_place, notes }
    }
}

/// A source of errors that two calibrations share where their place is one, with its column in either.
type Matched = (String, usize, usize);

fn matched(a: &CalibratedImu, b: &CalibratedImu) -> Vec<Matched> {
    let (Some(of_a), Some(of_b)) = (&a.shared, &b.shared) else { return Vec::new() };
    let in_b = |source: &String| of_b.sources.iter().position(|other| other == source);
    let sources = of_a.sources.iter().enumerate();
    sources.filter_map(|(k, source)| Some((source.clone(), k, in_b(source)?))).collect()
}

/// Both at one temperature, with their temperature terms where both have some.
fn brought_together(
    a: &CalibratedImu,
    b: &CalibratedImu,
    notes: &mut Vec<Diagnostic>,
) -> (CalibratedImu, CalibratedImu) {
    let reference_c = |imu: &CalibratedImu| imu.parameters.thermal.reference_c;
    let mut only = |name, imu: &CalibratedImu| {
        notes.push(ComparedAtTemperature { only: Some(name), temperature_c: reference_c(imu) }.into());
        // at its own reference nothing can fail
        imu.at(reference_c(imu)).unwrap_or_else(|_| imu.clone())
    };
    match (a.follows_temperature(), b.follows_temperature()) {
        (false, false) => (a.clone(), b.clone()),
        (true, false) => (only("A", a), b.clone()),
        (false, true) => (a.clone(), only("B", b)),
        (true, true) => {
            let (note, b) = match b.at_reference_temperature(reference_c(a)) {
                Ok(b) => (ComparedAtTemperature { only: None, temperature_c: reference_c(a) }.into(), b),
                Err(error) => (apart("to one temperature", &error), b.clone()),
            };
            notes.push(note);
            (a.clone(), b)
        }
    }
}

fn apart(to: &'static str, error: &Error) -> Diagnostic {
    NotBroughtTogether { to, why: Phrase(error.to_string()) }.into()
}

fn compared(
    a: &CalibratedImu,
    b: &CalibratedImu,
    in_a: InvariantValue,
    in_b: InvariantValue,
    common: &[Matched],
) -> ComparedQuantity {
    let invariant = in_a.invariant;
    let comparable =
        invariant.in_unit_of().is_none_or(|sensor_kind| a.unit(sensor_kind) == b.unit(sensor_kind));
    let difference = comparable.then_some(in_b.value - in_a.value);
    let sd = match (in_a.sd, in_b.sd) {
        // close to zero, one has no first-order sd, and neither has the difference
        (None, Some(_)) if covers(a, invariant) => None,
        (Some(_), None) if covers(b, invariant) => None,
        (None, None) => None,
        (one, other) => Some([one, other].map(Option::unwrap_or_default)),
    };
    let (of_a, of_b) = (a.shared_errors_of(invariant), b.shared_errors_of(invariant));
    let sum =
        |of: &dyn Fn(f64, f64) -> f64| common.iter().map(|(_, k, j)| of(of_a[*k], of_b[*j])).sum::<f64>();
    let apart = sum(&|u, v| (u - v).powi(2));
    let shared = [sum(&|u, _| u * u), sum(&|_, v| v * v)];
    let variances = sd.map(|sd| [0, 1].map(|k| (sd[k] * sd[k] - shared[k]).max(0.0) + 0.5 * apart));
    let sd = variances.map(|[one, other]| (one + other).sqrt()).filter(|sd| *sd > 0.0);
    let in_sd = difference.zip(sd).map(|(difference, sd)| difference / sd);
    let part = invariant.covariance_part();
    let degrees_of_freedom = together(&[variances.unwrap_or_default()], [a, b], part);
    let p_value = in_sd.and_then(|in_sd| f_p_value(in_sd * in_sd, 1, degrees_of_freedom));
    let (unit_a, unit_b) = (invariant.unit(a), invariant.unit(b));
    ComparedQuantity {
        invariant,
        unit_a,
        unit_b,
        a: in_a,
        b: in_b,
        difference,
        sd,
        in_sd,
        degrees_of_freedom,
        p_value,
    }
}

/// The note about standard deviations that count as known although nothing shows it.
fn about_degrees(name: &'static str, imu: &CalibratedImu) -> Option<Diagnostic> {
    imu.covariance.as_ref()?;
    let unknown = match imu.degrees_of_freedom {
        None => UnknownUncertainty::Degrees,
        Some(degrees) if degrees.accelerometer == 0.0 => UnknownUncertainty::Scatter,
        Some(_) => return None,
    };
    Some(SignificanceUncertain { of: Some(name), unknown }.into())
}

/// Degrees of freedom behind sums of two variances of one part, by the mean share of each.
fn together(variances: &[[f64; 2]], of: [&CalibratedImu; 2], part: CovariancePart) -> f64 {
    let degrees = of.map(|imu| imu.degrees_behind(part));
    let share =
        |[a, b]: &[f64; 2]| effective_degrees::probable_shares(&[(*a, degrees[0]), (*b, degrees[1])])[0];
    let of_a = variances.iter().map(share).sum::<f64>() / variances.len() as f64;
    effective_degrees::of_shares([(of_a, degrees[0]), (1.0 - of_a, degrees[1])])
}

/// Does the covariance of an IMU determine an invariant?
fn covers(imu: &CalibratedImu, invariant: Invariant) -> bool {
    let has_matrix = |sensor_kind: SensorKind| {
        let matrix = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Of(of, q) if *of == sensor_kind && q.entry().is_some());
        imu.quantities.iter().any(matrix)
    };
    imu.covariance.is_some()
        && match invariant {
            Invariant::Bias(sensor_kind, axis) => {
                imu.quantities.contains(&ImuQuantity::Of(sensor_kind, Quantity::Bias(axis)))
            }
            Invariant::Gain(sensor_kind, _) | Invariant::Angle(sensor_kind, ..) => has_matrix(sensor_kind),
            Invariant::AngleBetween(..) => SensorKind::ALL.into_iter().any(has_matrix),
            Invariant::Thermal(sensor_kind, term) => {
                imu.quantities.contains(&ImuQuantity::Thermal(sensor_kind, term))
            }
            Invariant::Nonlinear(term, axis) => imu
                .quantities
                .contains(&ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Nonlinear(term, axis))),
            Invariant::GSensitivity(_) => {
                imu.quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::GSensitivity(..)))
            }
        }
}

/// All parameters together, in the lower gauge of the first sensor that both have in one unit.
fn difference(
    a: &CalibratedImu,
    b: &CalibratedImu,
    common: &[Matched],
    notes: &mut Vec<Diagnostic>,
) -> Option<OverallDifference> {
    if a.covariance.is_none() && b.covariance.is_none() {
        return None;
    }
    let in_both =
        |sensor_kind: SensorKind| a.unit(sensor_kind).is_some() && a.unit(sensor_kind) == b.unit(sensor_kind);
    let known = |quantity: &ImuQuantity| match quantity {
        ImuQuantity::Of(sensor_kind, Quantity::Bias(_)) => {
            a.has_bias(*sensor_kind) && b.has_bias(*sensor_kind)
        }
        _ => true,
    };
    let reference = SensorKind::ALL.into_iter().find(|&sensor_kind| in_both(sensor_kind))?;
    let turned = (a.in_gauge_of(reference, Gauge::Lower), b.in_gauge_of(reference, Gauge::Lower));
    let (a, b) = match turned {
        (Ok(a), Ok(b)) => (a, b),
        (Err(error), _) | (_, Err(error)) => {
            notes.push(apart("into one frame", &error));
            return None;
        }
    };
    let mut list: Vec<ImuQuantity> = Vec::new();
    for imu in [&a, &b] {
        let listed = imu.quantities.iter().filter(|_| imu.covariance.is_some());
        let common = listed.filter(|quantity| in_both(quantity.sensor_kind()) && known(quantity));
        common.for_each(|quantity| {
            if !list.contains(quantity) {
                list.push(*quantity);
            }
        });
    }
    let u = shared_of(&a, &list, common.iter().map(|(_, k, _)| *k));
    let v = shared_of(&b, &list, common.iter().map(|(_, _, k)| *k));
    let of_a = covariance_of(&a, &list) - &u * u.transpose();
    let of_b = covariance_of(&b, &list) - &v * v.transpose();
    let apart = u - v;
    let sigma = &of_a + &of_b + &apart * apart.transpose();
    let difference = DVector::from_iterator(
        list.len(),
        list.iter().map(|quantity| quantity.value(&b.parameters) - quantity.value(&a.parameters)),
    );
    let (mut chi2, mut degrees_of_freedom, mut degrees_behind) = (0.0, 0, f64::INFINITY);
    let (mut places, mut of_parts) = (Vec::new(), Vec::new());
    for part in CovariancePart::ALL {
        let of_part = |k: &usize| list[*k].covariance_part() == part && sigma[(*k, *k)] > 0.0;
        let own: Vec<usize> = (0..list.len()).filter(of_part).collect();
        if own.is_empty() {
            continue;
        }
        let variances: Vec<_> =
            own.iter().map(|&k| [of_a[(k, k)], of_b[(k, k)]].map(|of| of.max(0.0))).collect();
        let behind = together(&variances, [&a, &b], part);
        places.extend(own);
        // what this part adds, beside the parts before it
        let (until_here, rank) = mahalanobis(
            &sigma.select_rows(&places).select_columns(&places),
            &difference.select_rows(&places),
        );
        of_parts.push(((until_here - chi2).max(0.0), rank.saturating_sub(degrees_of_freedom), behind));
        (chi2, degrees_of_freedom, degrees_behind) = (until_here, rank, degrees_behind.min(behind));
    }
    let p_value = match of_parts[..] {
        [(chi2, components, behind)] => f_p_value(chi2, components, behind),
        _ => chi2_p_value(of_parts.iter().map(as_known).sum(), degrees_of_freedom),
    }?;
    Some(OverallDifference { chi2, degrees_of_freedom, degrees_behind, p_value })
}

/// The χ² of known variances that is as probable as this one.
fn as_known(&(chi2, components, behind): &(f64, usize, f64)) -> f64 {
    let p_value = f_p_value(chi2, components, behind).filter(|_| behind.is_finite());
    p_value.map_or(chi2, |p_value| chi2_of_p_value(p_value, components))
}

/// The covariance of these quantities; zero for those that the IMU does not list.
fn covariance_of(imu: &CalibratedImu, list: &[ImuQuantity]) -> DMatrix<f64> {
    let place = |quantity: &ImuQuantity| imu.quantities.iter().position(|of| of == quantity);
    let places: Vec<Option<usize>> = list.iter().map(place).collect();
    DMatrix::from_fn(list.len(), list.len(), |i, j| match (&imu.covariance, places[i], places[j]) {
        (Some(covariance), Some(row), Some(column)) => covariance[(row, column)],
        _ => 0.0,
    })
}

/// What these shared sources do to these quantities: a column for each.
fn shared_of(
    imu: &CalibratedImu,
    list: &[ImuQuantity],
    sources: impl Iterator<Item = usize>,
) -> DMatrix<f64> {
    let sources: Vec<usize> = sources.collect();
    let place = |quantity: &ImuQuantity| imu.quantities.iter().position(|of| of == quantity);
    let places: Vec<Option<usize>> = list.iter().map(place).collect();
    DMatrix::from_fn(list.len(), sources.len(), |i, k| match (&imu.shared, places[i]) {
        (Some(shared), Some(row)) => shared.root[(row, sources[k])],
        _ => 0.0,
    })
}

/// `dᵀ Σ⁺ d` and the rank of `Σ`. `Σ` is scaled to unit diagonal, so units do not matter.
fn mahalanobis(sigma: &DMatrix<f64>, difference: &DVector<f64>) -> (f64, usize) {
    let sd = sigma.diagonal().map(|variance| variance.max(0.0).sqrt());
    let scale = sd.map(|sd| if sd > 0.0 { 1.0 / sd } else { 0.0 });
    let correlation = DMatrix::from_fn(sd.len(), sd.len(), |i, j| scale[i] * sigma[(i, j)] * scale[j]);
    let scaled = difference.component_mul(&scale);
    let eigen = correlation.symmetric_eigen();
    let least = 1e-10 * eigen.eigenvalues.amax();
    let mut chi2 = 0.0;
    let mut rank = 0;
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > least {
            chi2 += vector.dot(&scaled).powi(2) / value;
            rank += 1;
        }
    }
    (chi2, rank)
}

#[cfg(test)]
mod tests;
