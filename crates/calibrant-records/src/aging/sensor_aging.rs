//! The aging of a sensor: that of each of its quantities which do not depend on the true frame.

use super::line::{Aging, Dated};
use calibrant_core::estimate::tells_its_place;
use calibrant_core::sensor::{CalibratedImu, Invariant};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A calibration with its date.
#[derive(Debug, Clone, Copy)]
pub struct DatedCalibration<'a> {
    /// The date, years from any beginning.
    pub time_years: f64,
    /// The sensor as it was then.
    pub imu: &'a CalibratedImu,
    /// Where it was calibrated; `None` where that is not known. What all calibrations at one place share hides no aging.
    pub station: Option<&'a str>,
}

/// The aging of one quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct QuantityAging {
    /// Which quantity.
    #[serde(rename = "name")]
    pub invariant: Invariant,
    /// Its unit; an angle is in rad.
    pub unit: &'static str,
    /// Its change.
    #[serde(flatten)]
    pub aging: Aging,
}

/// The aging of each quantity of a sensor, in the order of a table. Calibrations with temperature terms are brought to the reference temperature of the last of them.
///
/// Quantities that have no standard deviation are left out. So are calibrations whose unit is not that of the last, and calibrations that cannot be brought to its reference
/// temperature, because the polynomial of a gain is not positive there.
#[must_use]
pub fn aging_of(calibrations: &[DatedCalibration<'_>]) -> Vec<QuantityAging> {
    let with_terms = calibrations.iter().rfind(|of| of.imu.follows_temperature());
    let reference_c = with_terms.map(|of| of.imu.parameters.thermal.reference_c);
    let referred = |imu: &CalibratedImu| match reference_c.filter(|_| imu.follows_temperature()) {
        Some(reference_c) => imu.at_reference_temperature(reference_c).ok(),
        None => Some(imu.clone()),
    };
    let found = calibrations.iter().filter_map(|of| {
        let imu = referred(of.imu)?;
        Some((of, imu.invariants(), imu))
    });
    let found: Vec<_> = found.collect();
    let Some((_, listed, last)) = found.last() else { return Vec::new() };
    let of_quantity = |invariant: Invariant| {
        let unit = invariant.unit(last);
        let same_unit = found.iter().filter(|(.., imu)| invariant.unit(imu) == unit);
        let values = same_unit.filter_map(|(of, values, imu)| {
            let value = values.iter().find(|value| value.invariant == invariant)?;
            let dated = Dated {
                time_years: of.time_years,
                value: value.value,
                sd: value.sd?,
                degrees_of_freedom: invariant.degrees_behind(imu),
            };
            Some((dated, errors(imu, of.station, invariant)))
        });
        let (values, errors): (Vec<Dated>, Vec<_>) = values.unzip();
        let aging = Aging::with_shared(&values, &columns(&errors))?;
        Some(QuantityAging { invariant, unit, aging })
    };
    listed.iter().filter_map(|value| of_quantity(value.invariant)).collect()
}

/// An error of an invariant: its place and its source, and its size.
type PlacedError = ((Option<String>, String), f64);

/// The errors that calibrations at this station share, as far as it is known which place that is.
fn errors(imu: &CalibratedImu, station: Option<&str>, invariant: Invariant) -> Vec<PlacedError> {
    let sources = imu.shared.iter().flat_map(|shared| &shared.sources);
    let placed = |(source, size): (&String, f64)| {
        let is_known = station.is_some() || tells_its_place(source);
        is_known.then(|| ((station.map(str::to_owned), source.clone()), size))
    };
    sources.zip(imu.shared_errors_of(invariant)).filter_map(placed).collect()
}

/// For each error that at least two values have: what it does to each value.
fn columns(errors: &[Vec<PlacedError>]) -> Vec<Vec<f64>> {
    let mut columns: BTreeMap<&(Option<String>, String), Vec<f64>> = BTreeMap::new();
    for (i, of_value) in errors.iter().enumerate() {
        for (place, size) in of_value {
            columns.entry(place).or_insert_with(|| vec![0.0; errors.len()])[i] = *size;
        }
    }
    let is_shared = |column: &Vec<f64>| column.iter().filter(|size| **size != 0.0).count() > 1;
    columns.into_values().filter(is_shared).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::estimate::Comparison;
    use calibrant_core::sensor::{
        CovarianceDegrees, Gauge, ImuParameters, ImuQuantity, ReadingUnit, SensorKind,
    };
    use nalgebra::DMatrix;

    #[test]
    fn a_sensor_ages_the_same_in_every_frame() {
        let imu_at = |years: f64| {
            let quantities = ImuQuantity::full_list(true, false, false);
            let size = quantities.len();
            let mut parameters = ImuParameters::identity();
            for (k, quantity) in quantities.iter().enumerate() {
                quantity.add_to(&mut parameters, 1e-3 * k as f64 * (1.0 + years));
            }
            CalibratedImu {
                covariance: Some(DMatrix::identity(size, size) * 1e-8),
                ..CalibratedImu::new(
                    parameters,
                    [Some(ReadingUnit::MetrePerSecondSquared), None],
                    quantities,
                    "",
                )
            }
        };
        let years = [0.0, 1.0, 2.5];
        let imus = years.map(imu_at);
        let turned = [Gauge::Lower, Gauge::Upper, Gauge::Symmetric];
        let turned: Vec<_> =
            imus.iter().zip(turned).map(|(imu, gauge)| imu.in_gauge(gauge).expect("regular")).collect();
        let of = |imus: &[CalibratedImu]| {
            let dated = years.iter().zip(imus).map(|(&time_years, imu)| DatedCalibration {
                time_years,
                imu,
                station: None,
            });
            aging_of(&dated.collect::<Vec<_>>())
        };
        let (one, other) = (of(&imus), of(&turned));
        let names: Vec<String> = one.iter().map(|of| of.invariant.name()).collect();
        assert_eq!(names.len(), 9, "{names:?}");
        for (one, other) in one.iter().zip(&other) {
            assert!((one.aging.per_year - other.aging.per_year).abs() < 1e-12, "{one:?} {other:?}");
            // a turned frame changes the sd only by the rounding of the rotation
            assert!((one.aging.sd / other.aging.sd - 1.0).abs() < 1e-6, "{one:?} {other:?}");
        }
        let bias_y = one[1].aging;
        assert!((bias_y.per_year - 1e-3).abs() < 1e-12 && bias_y.chi2 < 1e-9, "{bias_y:?}");
        assert!(aging_of(&[]).is_empty());
    }

    /// An accelerometer whose biases and gains follow temperature, about 20 °C.
    fn warm() -> CalibratedImu {
        let mut quantities = ImuQuantity::full_list(true, false, false);
        quantities.extend(ImuQuantity::all_thermal(true, false));
        let mut parameters = ImuParameters::identity();
        parameters.thermal.reference_c = 20.0;
        for (k, quantity) in quantities.iter().enumerate() {
            let size = match quantity {
                ImuQuantity::Thermal(_, term) => 1e-4 / 60f64.powi(term.order as i32 - 1),
                _ => 1e-3,
            };
            quantity.add_to(&mut parameters, size * (k as f64 % 5.0 - 2.5));
        }
        let size = quantities.len();
        let variance =
            |k: usize| if matches!(quantities[k], ImuQuantity::Thermal(..)) { 1e-12 } else { 1e-8 };
        let covariance = DMatrix::from_fn(size, size, |i, j| if i == j { variance(i) } else { 0.0 });
        CalibratedImu {
            covariance: Some(covariance),
            ..CalibratedImu::new(parameters, [Some(ReadingUnit::MetrePerSecondSquared), None], quantities, "")
        }
    }

    #[test]
    fn a_sensor_at_other_reference_temperatures_does_not_age() {
        let at = |reference_c: f64| warm().at_reference_temperature(reference_c).expect("positive gains");
        let imus = [20.0, 25.0, 35.0].map(at);
        let dated = |(k, imu)| DatedCalibration { time_years: k as f64, imu, station: None };
        let dated: Vec<_> = imus.iter().enumerate().map(dated).collect();
        let agings = aging_of(&dated);
        let thermal = agings.iter().filter(|of| matches!(of.invariant, Invariant::Thermal(..)));
        assert_eq!((agings.len(), thermal.count()), (9 + 30, 30));
        for of in agings {
            assert!(of.aging.per_year.abs() < 1e-9 * of.aging.sd, "{of:?}");
        }
    }

    #[test]
    fn a_calibration_that_does_not_reach_the_reference_temperature_is_left_out() {
        let mut narrow = warm();
        // the gain of x is zero at 30 °C
        narrow.parameters.thermal[SensorKind::Accelerometer].scale = Default::default();
        narrow.parameters.thermal[SensorKind::Accelerometer].scale[0].x = -0.1;
        let last = warm().at_reference_temperature(35.0).expect("positive gains");
        let of = |imus: &[&CalibratedImu]| {
            let dated = |(k, imu)| DatedCalibration { time_years: k as f64, imu, station: None };
            aging_of(&imus.iter().copied().enumerate().map(dated).collect::<Vec<_>>())
        };
        assert!(of(&[&narrow, &last]).is_empty(), "one calibration is no line");
        // one without temperature terms is taken as it is, and the last reference is that of the others
        let plain = warm().at(20.0).expect("its own reference");
        let (three, two) = (of(&[&narrow, &last, &plain]), of(&[&last, &plain]));
        assert_eq!(three.len(), 9);
        for (three, two) in three.iter().zip(&two) {
            assert!((three.aging.per_year - two.aging.per_year).abs() < 1e-12, "{three:?} {two:?}");
        }
    }

    #[test]
    fn the_aging_of_two_calibrations_is_as_significant_as_their_difference() {
        let known = f64::INFINITY;
        let degrees = |accelerometer| CovarianceDegrees {
            accelerometer,
            gyroscope_at_rest: known,
            gyroscope_matrix: known,
        };
        let before = CalibratedImu { degrees_of_freedom: Some(degrees(4.0)), ..warm() };
        let mut after = CalibratedImu { degrees_of_freedom: Some(degrees(9.0)), ..warm() };
        after.parameters[SensorKind::Accelerometer].bias.x += 3e-4;
        let dated = [(0.0, &before), (0.7, &after)];
        let agings =
            aging_of(&dated.map(|(time_years, imu)| DatedCalibration { time_years, imu, station: None }));
        let compared = Comparison::of(&before, &after).quantities;
        let (of, compared) = (agings[0].aging, &compared[0]);
        assert!((of.degrees_behind / compared.degrees_of_freedom - 1.0).abs() < 1e-9, "{of:?} {compared:?}");
        assert!(
            (of.p_value / compared.p_value.expect("a covariance") - 1.0).abs() < 1e-9,
            "{of:?} {compared:?}"
        );
        assert!(of.p_value > 0.05, "of known variances it would be 0.034: {of:?}");
    }
}
