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
    let unit = |symbol, factor| CoefficientUnit { symbol, factor };
    let degrees = 1_f64.to_degrees();
    let g = STANDARD_GRAVITY_MPS2;
    if readings == ReadingUnit::Counts {
        let symbol = match process {
            PowerLaw::Quantisation => "counts·s",
            PowerLaw::White => "counts/√Hz",
            PowerLaw::Flicker => "counts",
            PowerLaw::RandomWalk => "counts/√s",
        };
        return vec![unit(symbol, 1.0)];
    }
    match (sensor_kind, process) {
        (SensorKind::Accelerometer, PowerLaw::Quantisation) => vec![unit("m/s", 1.0)],
        (SensorKind::Accelerometer, PowerLaw::White) => {
            vec![unit("m/s²/√Hz", 1.0), unit("µg/√Hz", 1e6 / g), unit("m/s/√h", HOUR_S.sqrt())]
        }
        (SensorKind::Accelerometer, PowerLaw::Flicker) => vec![unit("m/s²", 1.0), unit("mg", 1e3 / g)],
        (SensorKind::Accelerometer, PowerLaw::RandomWalk) => {
            vec![unit("m/s²/√s", 1.0), unit("mg/√h", 1e3 / g * HOUR_S.sqrt())]
        }
        (SensorKind::Gyroscope, PowerLaw::Quantisation) => {
            vec![unit("rad", 1.0), unit("arcsec", degrees * HOUR_S)]
        }
        (SensorKind::Gyroscope, PowerLaw::White) => {
            vec![
                unit("rad/s/√Hz", 1.0),
                unit("(deg/s)/√Hz", degrees),
                unit("deg/√h", degrees * HOUR_S.sqrt()),
            ]
        }
        (SensorKind::Gyroscope, PowerLaw::Flicker) => {
            vec![unit("rad/s", 1.0), unit("deg/h", degrees * HOUR_S)]
        }
        (SensorKind::Gyroscope, PowerLaw::RandomWalk) => {
            vec![unit("rad/s/√s", 1.0), unit("deg/h/√h", degrees * HOUR_S * HOUR_S.sqrt())]
        }
    }
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
