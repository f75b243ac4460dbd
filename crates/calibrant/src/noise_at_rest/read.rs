//! Reads the recording that is examined for noise, in any format.

use super::options::NoiseOptions;
use crate::session::Source;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{ReadingUnit, SensorKind};
use calibrant_io::{ImuFile, ImuReadOptions, ImuUnit};

/// Reads the recording: one of a sensor, one of a whole IMU, or a pair. A recording whose columns do not name their sensor is one of the sensor of the options, or of an
/// accelerometer. A gain implies counts, if the file states no unit.
///
/// # Errors
/// As [`read_imu_sensor`](calibrant_io::read_imu_sensor); and where a gain is given, and the file states a unit.
pub fn read_for_noise(source: &Source, reading: &ImuReadOptions, noise: &NoiseOptions) -> Result<ImuFile> {
    let sensor_kind = noise.sensor.unwrap_or(SensorKind::Accelerometer);
    let mut options = reading.clone();
    if noise.sensor.is_some() {
        // the unit of the other sensor is not needed: it only shows when the IMU is stationary
        options.counts_unless_stated = SensorKind::ALL.map(|other| other != sensor_kind);
    }
    let open = |options: &ImuReadOptions| source.read_sensor(sensor_kind, options);
    let counted = || {
        let kinds = noise.gains.iter().map(|(sensor_kind, _)| *sensor_kind);
        kinds.filter(|sensor_kind| options.unit(*sensor_kind).is_none())
    };
    if counted().next().is_none() {
        return open(&options);
    }
    let in_counts = counted()
        .fold(options.clone(), |options, sensor_kind| options.with_unit(sensor_kind, Some(ImuUnit::Counts)));
    open(&in_counts).map_err(|error| {
        let stated = open(&options).ok();
        let other = counted().find_map(|sensor_kind| {
            let unit = stated.as_ref()?.recording.sensor(sensor_kind)?.unit();
            (unit != ReadingUnit::Counts).then_some((sensor_kind, unit))
        });
        match other {
            Some((sensor_kind, unit)) => {
                let message = format!(
                    "option `gain` is one of counts, but the file gives the {sensor_kind} in {}",
                    unit.symbol()
                );
                Error::experiment(InputError::new(Refusal::UnitContradicted, message, "omit option `gain`"))
            }
            None => error,
        }
    })
}
