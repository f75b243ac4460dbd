//! The recording, whatever its format, and what the user says of it.

use super::arguments::{Arguments, Gains};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::io::{ImuFile, ImuReadOptions, ImuUnit, read_imu_pair, read_imu_sensor};
use calibrant::sensor::{ReadingUnit, Triad};

/// Reads the recording: a file of one sensor, one of a whole IMU, or a pair. `triad` is the sensor of a file whose columns do not say.
pub(super) fn read(arguments: &Arguments, triad: Triad, gains: &Gains) -> calibrant::Result<ImuFile> {
    let options = options(arguments, triad)?;
    let open = |options: &ImuReadOptions| match &arguments.gyroscope {
        Some(gyroscope) => read_imu_pair(&arguments.recording, gyroscope, options),
        None => read_imu_sensor(&arguments.recording, triad, options),
    };
    // a gain is one of counts: it answers for the unit where the file does not
    let counted = || gains.iter().map(|(triad, _)| *triad).filter(|triad| options.unit(*triad).is_none());
    if counted().next().is_none() {
        return open(&options);
    }
    let in_counts =
        counted().fold(options.clone(), |options, triad| options.with_unit(triad, Some(ImuUnit::Counts)));
    open(&in_counts).map_err(|error| {
        let stated = open(&options).ok();
        let other = counted().find_map(|triad| {
            let unit = stated.as_ref()?.recording.triad(triad)?.unit;
            (unit != ReadingUnit::Counts).then_some((triad, unit))
        });
        match other {
            Some((triad, unit)) => usage(
                &format!("--gain is one of counts, but the file gives the {triad} in {}", unit.symbol()),
                "leave --gain away",
            ),
            None => error,
        }
    })
}

/// The options, with --unit as that of the sensor. The unit of one that --sensor leaves aside is not asked for: it only tells when the IMU is still.
fn options(arguments: &Arguments, triad: Triad) -> calibrant::Result<ImuReadOptions> {
    let mut options = arguments.reading.with_columns(arguments.columns.as_deref())?;
    if arguments.sensor.is_some() {
        options.counts_unless_stated = Triad::ALL.map(|other| other != triad);
    }
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
