//! The sensors on a machine as their datasheets describe them: where a calibration begins, and what it estimates.

use super::Experiment;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{
    Axis, ImuParameters, ImuQuantity, ImuRecording, ParameterList, Sensor, SensorKind, SensorModel,
};
use nalgebra::{Matrix3, Vector3};

impl Experiment {
    /// The sensors of the datasheets: where a calibration on a machine begins to search.
    ///
    /// # Errors
    /// [`Error::Experiment`] where readings in counts have no nominal gain.
    pub fn nominal(&self) -> Result<ImuParameters> {
        let missing = |key: &str| {
            let message = "counts need a nominal gain on a machine: the search begins with it";
            Error::experiment(InputError::new(Refusal::KeyMissing, message, "add it").about_key(key))
        };
        let mut nominal = ImuParameters::identity();
        let Sensor { gain, offset, .. } = self.sensor;
        let gain = gain.ok_or_else(|| missing("sensor.gain_counts_per_mps2"))?;
        nominal[SensorKind::Accelerometer].matrix = Matrix3::from_diagonal(&gain);
        nominal[SensorKind::Accelerometer].bias = offset.unwrap_or_default();
        if let Some(gyroscope) = self.imu.as_ref().map(|imu| &imu.gyroscope) {
            let in_si = gyroscope.unit == SensorKind::Gyroscope.stimulus_unit();
            let gain = gyroscope.gain.or(in_si.then(|| Vector3::repeat(1.0)));
            let gain = gain.ok_or_else(|| missing("gyroscope.gain_counts_per_radps"))?;
            nominal[SensorKind::Gyroscope].matrix = Matrix3::from_diagonal(&gain);
        }
        Ok(nominal)
    }

    /// The parameters of those sensors that were recorded: what a calibration on a machine estimates of them.
    #[must_use]
    pub fn quantities(&self, recording: &ImuRecording) -> Vec<ImuQuantity> {
        self.quantities_of(|kind| recording.sensor(kind).is_some())
    }

    /// The parameters of those sensors that there are.
    #[must_use]
    pub fn quantities_of(&self, is_there: impl Fn(SensorKind) -> bool) -> Vec<ImuQuantity> {
        let of = |kind: SensorKind, model: SensorModel| {
            let list = ParameterList::new(3, model);
            let quantities = list.quantities().iter().map(|quantity| ImuQuantity::Of(kind, *quantity));
            quantities.collect::<Vec<_>>()
        };
        let mut quantities = Vec::new();
        if is_there(SensorKind::Accelerometer) {
            quantities.extend(of(SensorKind::Accelerometer, self.sensor.model));
        }
        if let Some(imu) = self.imu.as_ref().filter(|_| is_there(SensorKind::Gyroscope)) {
            quantities.extend(of(SensorKind::Gyroscope, imu.gyroscope.model));
            if imu.gyroscope.g_sensitivity {
                let entries = Axis::ALL.into_iter().flat_map(|row| Axis::ALL.map(|column| (row, column)));
                quantities.extend(entries.map(|(row, column)| ImuQuantity::GSensitivity(row, column)));
            }
        }
        quantities
    }
}
