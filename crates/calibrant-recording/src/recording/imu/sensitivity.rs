//! The sensitivity of a converter, by which its counts are readings in a physical unit.

use calibrant_core::number_format::plain;
use calibrant_core::sensor::SensorKind;
use std::f64::consts::PI;
use std::fmt;

/// Standard gravity, m/s²: what a reading of 1 g means.
pub(super) const STANDARD_GRAVITY_MPS2: f64 = 9.80665;

/// Counts per m/s² of an accelerometer, per rad/s of a gyroscope. It is written as in datasheets, `16384 LSB/g` or `131 LSB/dps`.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::SensorKind;
/// use calibrant_recording::Sensitivity;
/// let of_datasheet = Sensitivity::new(SensorKind::Accelerometer, 16384.0 / 9.80665).expect("a sensitivity");
/// assert_eq!(of_datasheet.to_string(), "16384 LSB/g");
/// assert_eq!(Sensitivity::new(SensorKind::Accelerometer, 0.0), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitivity {
    sensor_kind: SensorKind,
    counts_per_unit: f64,
}

/// No part of it is NaN.
impl Eq for Sensitivity {}

impl Sensitivity {
    /// Of this sensor, in counts per m/s² or rad/s. `None` where that is no finite number above 0.
    #[must_use]
    pub fn new(sensor_kind: SensorKind, counts_per_unit: f64) -> Option<Self> {
        (counts_per_unit.is_finite() && counts_per_unit > 0.0)
            .then_some(Self { sensor_kind, counts_per_unit })
    }

    /// Of this sensor.
    #[must_use]
    pub fn sensor_kind(self) -> SensorKind {
        self.sensor_kind
    }

    /// Counts per m/s² or rad/s.
    #[must_use]
    pub fn counts_per_unit(self) -> f64 {
        self.counts_per_unit
    }

    /// The same, `factor` times as large.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { counts_per_unit: self.counts_per_unit * factor, ..self }
    }
}

impl fmt::Display for Sensitivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (size, unit) = match self.sensor_kind {
            SensorKind::Accelerometer => (STANDARD_GRAVITY_MPS2, "g"),
            SensorKind::Gyroscope => (PI / 180.0, "dps"),
        };
        write!(f, "{} LSB/{unit}", plain(self.counts_per_unit * size, 6))
    }
}
