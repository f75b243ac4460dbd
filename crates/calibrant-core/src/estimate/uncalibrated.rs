//! A sensor without its calibration, as the reference for the improvement.

use crate::sensor::{Correction, ReadingUnit, Sensor, SensorParameters};
use nalgebra::{Matrix3, Vector3};

/// A sensor before its calibration: the datasheet's values, or the simplest plausible ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncalibrated {
    /// One gain for each axis, an order of the axes, and a bias.
    pub sensor: SensorParameters,
    /// The source of gain and bias, in words: `the datasheet's gain and offset`.
    pub source: String,
}

impl Uncalibrated {
    /// An accelerometer from its datasheet. A missing gain or offset is replaced by the mean of the estimates, one for all axes.
    ///
    /// # Examples
    /// Readings in m/s² are taken as they are:
    /// ```
    /// use calibrant_core::estimate::Uncalibrated;
    /// use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
    /// use nalgebra::Vector3;
    ///
    /// let found = SensorParameters { bias: Vector3::repeat(0.1), ..SensorParameters::identity() };
    /// let before = Uncalibrated::accelerometer(&Sensor::triaxial(SensorModel::Full), &found);
    /// assert_eq!(before.stimulus(&Vector3::new(0.0, 0.0, 9.9)), Some(Vector3::new(0.0, 0.0, 9.9)));
    /// assert_eq!(before.source, "the readings as they are");
    /// ```
    #[must_use]
    pub fn accelerometer(datasheet: &Sensor, found: &SensorParameters) -> Self {
        let own = found.gains();
        let source = match (datasheet.unit, datasheet.gain, datasheet.offset) {
            (ReadingUnit::Counts, Some(_), Some(_)) => "the datasheet's gain and offset",
            (ReadingUnit::Counts, Some(_), None) => {
                "the datasheet's gain, and one offset for all axes: the mean of those found"
            }
            (ReadingUnit::Counts, None, Some(_)) => {
                "the datasheet's offset, and one gain for all axes: the mean of those found"
            }
            (ReadingUnit::Counts, None, None) => {
                "one gain and one offset for all axes: the means of those found"
            }
            _ => "the readings as they are",
        };
        let gain = datasheet.gain.unwrap_or_else(|| Vector3::repeat(own.mean()));
        let bias = datasheet.offset.unwrap_or_else(|| Vector3::repeat(found.bias.mean()));
        Self {
            sensor: SensorParameters::linear(bias, Matrix3::from_diagonal(&gain)),
            source: source.to_owned(),
        }
    }

    /// The stimulus of a reading without calibration: `C (y − b)`. `None` for a zero gain.
    #[must_use]
    pub fn stimulus(&self, reading: &Vector3<f64>) -> Option<Vector3<f64>> {
        Correction::of(&self.sensor).map(|correction| correction.apply(reading))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorModel;

    #[test]
    fn what_the_datasheet_does_not_give_is_one_for_all_axes() {
        let matrix = Matrix3::new(3.0, 0.0, 4.0, 0.0, 6.0, 0.0, 0.0, 0.0, 7.0);
        let found = SensorParameters::linear(Vector3::new(33000.0, 33300.0, 32400.0), matrix);
        let counts = Sensor {
            unit: ReadingUnit::Counts,
            gain: None,
            offset: None,
            ..Sensor::triaxial(SensorModel::Full)
        };
        let before = Uncalibrated::accelerometer(&counts, &found);
        assert_eq!(before.sensor.bias, Vector3::repeat(32900.0));
        assert!((before.sensor.matrix - Matrix3::identity() * 6.0).amax() < 1e-12);
        assert!(before.source.contains("one gain and one offset"));
        let given = Sensor { gain: Some(Vector3::repeat(5.0)), ..counts };
        let before = Uncalibrated::accelerometer(&given, &found);
        assert_eq!(
            before.stimulus(&Vector3::new(32905.0, 32900.0, 32890.0)),
            Some(Vector3::new(1.0, 0.0, -2.0))
        );
        assert!(before.source.starts_with("the datasheet's gain, and one offset"));
    }
}
