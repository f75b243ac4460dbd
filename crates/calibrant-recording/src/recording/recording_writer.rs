//! Writes `recording.csv`.

use crate::text::numbers::write_numbers;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Axis, ImuRecording, ReadingUnit, Recording, SensorKind};
use std::iter::once;
use std::path::Path;

/// Writes a recording as CSV with the header `t_s,ax_mps2,ay_mps2,az_mps2` (or `_counts`; only `ax` for one axis).
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_recording(path: &Path, recording: &Recording) -> Result<()> {
    let samples = recording.times_s().iter().zip(recording.readings());
    let rows = samples.map(|(t, y)| once(*t).chain(y.iter().take(recording.axes()).copied()));
    let columns = names('a', recording.active_axes(), recording.unit());
    write_numbers(path, &format!("t_s{columns}"), rows)
}

/// The names of a sensor's columns, each with a comma before it.
fn names(letter: char, axes: &[Axis], unit: ReadingUnit) -> String {
    axes.iter().map(|axis| format!(",{letter}{axis}_{}", unit.suffix())).collect()
}

/// Writes a recording of an IMU as CSV with the header `t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps` (or `_counts`), and
/// `temp_c` where its temperature is known. Of an accelerometer alone there are no columns of a gyroscope.
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Recording`] where there is no accelerometer, or where the sensors' times differ: this file has no place for
/// them. [`Error::Output`] where it cannot be written.
pub fn write_imu_recording(path: &Path, recording: &ImuRecording) -> Result<()> {
    let Some(accelerometer) = &recording[SensorKind::Accelerometer] else {
        let input_error = InputError::new(
            Refusal::SensorMissing,
            "the recording has no accelerometer",
            "write the gyroscope's recording by itself",
        );
        return Err(Error::recording(input_error));
    };
    let gyroscope = recording[SensorKind::Gyroscope].as_ref();
    if gyroscope.is_some_and(|gyroscope| accelerometer.times_s() != gyroscope.times_s()) {
        let input_error = InputError::new(
            Refusal::RecordingsUnlike,
            "the sensors have different sample times",
            "write each sensor's recording by itself",
        );
        return Err(Error::recording(input_error));
    }
    let temperature = recording.temperature_c.as_deref();
    let header = [
        "t_s",
        &names('a', &Axis::ALL, accelerometer.unit()),
        &gyroscope.map_or_else(String::new, |of| names('g', &Axis::ALL, of.unit())),
        if temperature.is_some() { ",temp_c" } else { "" },
    ];
    let rows = accelerometer.times_s().iter().zip(accelerometer.readings()).enumerate().map(|(k, (t, a))| {
        let rates = gyroscope.and_then(|gyroscope| gyroscope.readings().get(k)).into_iter().flatten();
        let celsius = temperature.and_then(|values| values.get(k));
        once(t).chain(a).chain(rates).chain(celsius).copied()
    });
    write_numbers(path, &header.concat(), rows)
}
