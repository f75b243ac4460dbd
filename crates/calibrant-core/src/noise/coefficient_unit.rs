//! Units of the noise coefficients: SI, and the customary ones of datasheets.

use super::PowerLaw;
use crate::sensor::{ReadingUnit, SensorKind};

/// Standard gravity, m/s²: what 1 g means in a datasheet.
const STANDARD_GRAVITY_MPS2: f64 = 9.80665;
/// Seconds in an hour.
const HOUR_S: f64 = 3600.0;

/// A unit of a coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoefficientUnit {
    /// As it is printed: `µg/√Hz`.
    pub symbol: &'static str,
    /// Number in this unit over the number in the unit of the readings, seconds and hertz.
    pub factor: f64,
}

/// Units of a coefficient for readings in this unit. First comes that of the readings with seconds, then the
/// customary ones.
///
/// # Examples
/// ```
/// use calibrant_core::noise::{PowerLaw, coefficient_units};
/// use calibrant_core::sensor::{ReadingUnit, SensorKind};
///
/// let units = coefficient_units(SensorKind::Gyroscope, PowerLaw::White, ReadingUnit::RadianPerSecond);
/// let symbols: Vec<_> = units.iter().map(|unit| unit.symbol).collect();
/// assert_eq!(symbols, ["rad/s/√Hz", "(deg/s)/√Hz", "deg/√h"]);
/// ```
#[must_use]
pub fn coefficient_units(
    sensor_kind: SensorKind,
    process: PowerLaw,
    readings: ReadingUnit,
) -> Vec<CoefficientUnit> {
    let (g, hour) = (STANDARD_GRAVITY_MPS2, HOUR_S.sqrt());
    let degrees = 1_f64.to_degrees();
    let units: &[(&'static str, f64)] = match (readings, sensor_kind, process) {
        (ReadingUnit::Counts, _, PowerLaw::Quantisation) => &[("counts·s", 1.0)],
        (ReadingUnit::Counts, _, PowerLaw::White) => &[("counts/√Hz", 1.0)],
        (ReadingUnit::Counts, _, PowerLaw::Flicker) => &[("counts", 1.0)],
        (ReadingUnit::Counts, _, PowerLaw::RandomWalk) => &[("counts/√s", 1.0)],
        (_, SensorKind::Accelerometer, PowerLaw::Quantisation) => &[("m/s", 1.0)],
        (_, SensorKind::Accelerometer, PowerLaw::White) => {
            &[("m/s²/√Hz", 1.0), ("µg/√Hz", 1e6 / g), ("m/s/√h", hour)]
        }
        (_, SensorKind::Accelerometer, PowerLaw::Flicker) => &[("m/s²", 1.0), ("mg", 1e3 / g)],
        (_, SensorKind::Accelerometer, PowerLaw::RandomWalk) => {
            &[("m/s²/√s", 1.0), ("mg/√h", 1e3 / g * hour)]
        }
        (_, SensorKind::Gyroscope, PowerLaw::Quantisation) => &[("rad", 1.0), ("arcsec", degrees * HOUR_S)],
        (_, SensorKind::Gyroscope, PowerLaw::White) => {
            &[("rad/s/√Hz", 1.0), ("(deg/s)/√Hz", degrees), ("deg/√h", degrees * hour)]
        }
        (_, SensorKind::Gyroscope, PowerLaw::Flicker) => &[("rad/s", 1.0), ("deg/h", degrees * HOUR_S)],
        (_, SensorKind::Gyroscope, PowerLaw::RandomWalk) => {
            &[("rad/s/√s", 1.0), ("deg/h/√h", degrees * HOUR_S * hour)]
        }
    };
    units.iter().map(|&(symbol, factor)| CoefficientUnit { symbol, factor }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_are_those_of_datasheets() {
        let factors = |sensor_kind, process, unit| -> Vec<f64> {
            coefficient_units(sensor_kind, process, unit).iter().map(|unit| unit.factor).collect()
        };
        // 0.05 m/s/√h is 85 µg/√Hz
        let n = factors(SensorKind::Accelerometer, PowerLaw::White, ReadingUnit::MetrePerSecondSquared);
        assert!((0.05 / n[2] * n[1] - 84.98).abs() < 0.01);
        // 0.01 (deg/s)/√Hz is 0.6 deg/√h
        let n = factors(SensorKind::Gyroscope, PowerLaw::White, ReadingUnit::RadianPerSecond);
        assert!((0.01 / n[1] * n[2] - 0.6).abs() < 1e-12);
        let b = factors(SensorKind::Gyroscope, PowerLaw::Flicker, ReadingUnit::RadianPerSecond);
        assert!((b[1] - 206_264.8).abs() < 0.01);
    }
}
