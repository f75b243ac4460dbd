//! A calibration of readings in a physical unit as one of the counts behind them.

use super::{CalibratedImu, ReadingUnit, SensorKind};

impl CalibratedImu {
    /// The same sensors with the counts of their converters as readings, where their sensitivity is known: `counts = k y` has the bias `k b` and the matrix
    /// `k S`. Covariance and shared errors are left out.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ReadingUnit, SensorKind};
    /// let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
    /// let mut imu = CalibratedImu::new(ImuParameters::identity(), units, vec![], "");
    /// assert_eq!(imu.in_counts().unit(SensorKind::Accelerometer), units[0], "nothing is known of counts");
    /// imu.counts_per_unit[SensorKind::Accelerometer] = Some(1670.0);
    /// let raw = imu.in_counts();
    /// assert_eq!(raw.unit(SensorKind::Accelerometer), Some(ReadingUnit::Counts));
    /// assert_eq!(raw.parameters[SensorKind::Accelerometer].matrix[(0, 0)], 1670.0);
    /// ```
    #[must_use]
    pub fn in_counts(&self) -> Self {
        let mut raw = Self { covariance: None, degrees_of_freedom: None, shared: None, ..self.clone() };
        for (sensor_kind, &counts) in self.counts_per_unit.present() {
            raw.units[sensor_kind] = Some(ReadingUnit::Counts);
            raw.counts_per_unit[sensor_kind] = None;
            let sensor = &mut raw.parameters[sensor_kind];
            sensor.bias *= counts;
            sensor.matrix *= counts;
            raw.parameters.thermal[sensor_kind].bias.iter_mut().for_each(|bias| *bias *= counts);
            if sensor_kind == SensorKind::Gyroscope {
                raw.parameters.g_sensitivity *= counts;
            }
        }
        raw
    }
}
