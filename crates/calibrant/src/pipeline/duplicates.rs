//! A calibration is not tried on the data that it is from.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{HoldCalibration, noise_in_common, readings_in_common};
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{Recording, SensorKind};
use std::path::Path;

/// A sensor's readings, and the hash of the files that they are from.
pub(crate) struct Readings<'a> {
    pub(crate) sha256: String,
    pub(crate) recording: Option<&'a Recording>,
}

/// Refuses the data of a sensor that were calibrated from: the same file, its readings in another file, whole or cut, in another order, or the recording in disguise.
pub(crate) fn refuse_duplicate(
    sensor_kind: SensorKind,
    one: &Readings<'_>,
    holds: &HoldCalibration,
    other: &Readings<'_>,
    path: &Path,
) -> Result<()> {
    let refused = |what: &str| {
        let message = format!("{what}; errors on them are smaller than on other data, and validate nothing");
        let help = "give another recording of the sensor, or --folds 5 in place of --validate: blocks of holds, each predicted from the others";
        Err(Error::experiment(InputError::new(Refusal::RecordingRepeated, message, help).in_file(path)))
    };
    let same = match sensor_kind {
        SensorKind::Accelerometer => "it has the data that were calibrated from",
        SensorKind::Gyroscope => "its gyroscope has the data that were calibrated from",
    };
    if one.sha256 == other.sha256 {
        return refused(same);
    }
    let Some((one, other)) = one.recording.zip(other.recording) else { return Ok(()) };
    let (long, short) = if one.len() < other.len() { (other, one) } else { (one, other) };
    if long.readings.windows(short.len().max(1)).any(|segment| segment == short.readings) {
        return refused(same);
    }
    let holds: Vec<Hold> = holds.holds.iter().map(|result| result.hold.clone()).collect();
    let (in_common, correlation) =
        rayon::join(|| readings_in_common(one, &holds, other), || noise_in_common(one, &holds, other));
    if let Some(share) = in_common {
        let percent = (100.0 * share).floor();
        return refused(&format!(
            "{same}, in another order (reversed, its parts exchanged?): {percent} % of the readings in holds are in it to the last digit"
        ));
    }
    match correlation {
        Some(correlation) => refused(&format!(
            "{same}, in another form (rounded, smoothed, thinned out, in other units?): the noise of its samples is theirs (correlation {correlation:.2}, where another recording has none)"
        )),
        None => Ok(()),
    }
}
