//! Reads the recording for `calibrant noise`, in any format, with the user's options.

use super::arguments::{Arguments, Gains};
use crate::recording_options::completed;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{ImuFile, ImuReadOptions, ImuUnit, read_imu_pair, read_imu_sensor};
use calibrant::sensor::{ReadingUnit, SensorKind};

/// Reads the recording: a file of one sensor, one of a whole IMU, or a pair. `sensor_kind` is the sensor of a
/// file whose columns do not name it.
pub(super) fn read(
    arguments: &Arguments,
    sensor_kind: SensorKind,
    gains: &Gains,
) -> calibrant::Result<ImuFile> {
    let options = options(arguments, sensor_kind)?;
    let open = |options: &ImuReadOptions| match &arguments.gyroscope {
        Some(gyroscope) => read_imu_pair(&arguments.recording, gyroscope, options),
        None => read_imu_sensor(&arguments.recording, sensor_kind, options),
    };
    // a gain implies counts, if the file states no unit
    let counted = || {
        gains
            .iter()
            .map(|(sensor_kind, _)| *sensor_kind)
            .filter(|sensor_kind| options.unit(*sensor_kind).is_none())
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
            Some((sensor_kind, unit)) => usage(
                &format!(
                    "--gain is one of counts, but the file gives the {sensor_kind} in {}",
                    unit.symbol()
                ),
                "omit --gain",
            ),
            None => error,
        }
    })
}

/// The options, with --unit as that of the sensor. The unit of a sensor that --sensor excludes is not needed:
/// it only shows when the IMU is stationary.
fn options(arguments: &Arguments, sensor_kind: SensorKind) -> calibrant::Result<ImuReadOptions> {
    let given = arguments.reading.options_of(sensor_kind)?;
    let mut options = completed(given, arguments.columns.as_deref())?;
    if arguments.sensor.is_some() {
        options.counts_unless_stated = SensorKind::ALL.map(|other| other != sensor_kind);
    }
    Ok(options)
}

fn usage(message: &str, help: &str) -> Error {
    Error::Experiment(Box::new(InputError::new(Refusal::UnitContradicted, message, help)))
}
