//! The aging of a sensor: that of each of its quantities which do not depend on the true frame.

use super::aging::{Aging, Dated};
use crate::sensor::{CalibratedImu, Invariant};

/// A calibration with its date.
#[derive(Debug, Clone, Copy)]
pub struct DatedCalibration<'a> {
    /// The date, years from any beginning.
    pub time_years: f64,
    /// The sensor as it was then.
    pub imu: &'a CalibratedImu,
}

/// The aging of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityAging {
    /// Which quantity.
    pub invariant: Invariant,
    /// Its unit; an angle is in rad.
    pub unit: &'static str,
    /// Its change.
    pub aging: Aging,
}

/// The aging of each quantity of a sensor, in the order of a table. Quantities that have no standard deviation are left out; and calibrations whose unit is not that of the last.
#[must_use]
pub fn aging_of(calibrations: &[DatedCalibration<'_>]) -> Vec<QuantityAging> {
    let found: Vec<_> = calibrations.iter().map(|of| (of, of.imu.invariants())).collect();
    let Some((last, listed)) = found.last() else { return Vec::new() };
    let of_quantity = |invariant: Invariant| {
        let unit = invariant.unit(last.imu);
        let same_unit = found.iter().filter(|(of, _)| invariant.unit(of.imu) == unit);
        let values = same_unit.filter_map(|(of, values)| {
            let value = values.iter().find(|value| value.invariant == invariant)?;
            Some(Dated { time_years: of.time_years, value: value.value, sd: value.sd? })
        });
        let aging = Aging::of(&values.collect::<Vec<_>>())?;
        Some(QuantityAging { invariant, unit, aging })
    };
    listed.iter().filter_map(|value| of_quantity(value.invariant)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{Gauge, ImuParameters, ImuQuantity, ReadingUnit};
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
                parameters,
                accelerometer_unit: Some(ReadingUnit::MetrePerSecondSquared),
                gyroscope_unit: None,
                quantities,
                covariance: Some(DMatrix::identity(size, size) * 1e-8),
                degrees_of_freedom: None,
                frame: String::new(),
            }
        };
        let years = [0.0, 1.0, 2.5];
        let imus = years.map(imu_at);
        let turned = [Gauge::Lower, Gauge::Upper, Gauge::Symmetric];
        let turned: Vec<_> =
            imus.iter().zip(turned).map(|(imu, gauge)| imu.in_gauge(gauge).expect("regular")).collect();
        let of = |imus: &[CalibratedImu]| {
            let dated = years.iter().zip(imus).map(|(&time_years, imu)| DatedCalibration { time_years, imu });
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
}
