//! The recording, whatever its format, and what the user says of it.

use super::Arguments;
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::io::{ImuFile, ImuReadOptions, ImuUnit, read_imu_sensor};
use calibrant::sensor::{ReadingUnit, Triad};

/// Reads the recording of a sensor, from a file of its own or from one of a whole IMU.
pub(super) fn read(arguments: &Arguments, triad: Triad) -> calibrant::Result<ImuFile> {
    let options = options(arguments, triad)?;
    let path = &arguments.recording;
    if arguments.gain.is_empty() || options.unit(triad).is_some() {
        return read_imu_sensor(path, triad, &options);
    }
    // a gain is one of counts: it answers for the unit where the file does not
    let in_counts = options.clone().with_unit(triad, Some(ImuUnit::Counts));
    read_imu_sensor(path, triad, &in_counts).map_err(|error| {
        let stated = read_imu_sensor(path, triad, &options).ok();
        let unit = stated.as_ref().and_then(|file| Some(file.recording.triad(triad)?.unit));
        match unit.filter(|unit| *unit != ReadingUnit::Counts) {
            Some(unit) => usage(
                &format!("--gain is one of counts, but the file gives the {triad} in {}", unit.symbol()),
                "leave --gain away",
            ),
            None => error,
        }
    })
}

/// The options, with --unit as that of the sensor.
fn options(arguments: &Arguments, triad: Triad) -> calibrant::Result<ImuReadOptions> {
    let options = arguments.reading.with_columns(arguments.columns.as_deref())?;
    let Some(unit) = arguments.unit else { return Ok(options) };
    if !unit.suits(triad) {
        let message = format!("--unit {} is no unit of the {triad}", unit.symbol());
        return Err(usage(&message, &format!("its readings are in {}", ImuUnit::choices(triad))));
    }
    match options.unit(triad).filter(|other| *other != unit) {
        Some(other) => Err(usage(
            &format!("--unit is {}, but the {triad}'s unit is given as {}", unit.symbol(), other.symbol()),
            "leave one of them away",
        )),
        None => Ok(options.with_unit(triad, Some(unit))),
    }
}

fn usage(message: &str, help: &str) -> Error {
    Error::Experiment(Box::new(Complaint::new(message, help)))
}
