//! Writes `recording.csv`.

use crate::files::atomic_output::write_atomically;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Axis, ImuRecording, Recording, SensorKind};
use std::path::Path;

/// Writes a recording as CSV with the header `t_s,ax_mps2,ay_mps2,az_mps2` (or `_counts`; only `ax` for one axis).
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_recording(path: &Path, recording: &Recording) -> Result<()> {
    write_atomically(path, |out| {
        write!(out, "t_s")?;
        for axis in recording.active_axes() {
            write!(out, ",a{axis}_{}", recording.unit().suffix())?;
        }
        writeln!(out)?;
        for (t, reading) in recording.times_s().iter().zip(recording.readings()) {
            write!(out, "{t:?}")?;
            for value in &reading.as_slice()[..recording.axes()] {
                write!(out, ",{value:?}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}

/// Writes a recording of an IMU as CSV with the header `t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps` (or `_counts`), and
/// `temp_c` where its temperature is known.
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Recording`] where a sensor is missing or the sensors' times differ: this file has no place for
/// them. [`Error::Output`] where it cannot be written.
pub fn write_imu_recording(path: &Path, recording: &ImuRecording) -> Result<()> {
    let (Some(accelerometer), Some(gyroscope)) = (&recording.accelerometer, &recording.gyroscope) else {
        let input_error = InputError::new(
            Refusal::SensorMissing,
            "the recording has one sensor only",
            "write that sensor's recording",
        );
        return Err(Error::recording(input_error));
    };
    if accelerometer.times_s() != gyroscope.times_s() {
        let input_error = InputError::new(
            Refusal::RecordingsUnlike,
            "the sensors have different sample times",
            "write each sensor's recording by itself",
        );
        return Err(Error::recording(input_error));
    }
    write_atomically(path, |out| {
        write!(out, "t_s")?;
        for (sensor_kind, readings) in
            [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)]
        {
            for axis in Axis::ALL {
                write!(out, ",{}{axis}_{}", &sensor_kind.name()[..1], readings.unit().suffix())?;
            }
        }
        let temperature = recording.temperature_c.as_deref();
        writeln!(out, "{}", if temperature.is_some() { ",temp_c" } else { "" })?;
        let readings = accelerometer.readings().iter().zip(gyroscope.readings());
        for (k, (t, (a, g))) in accelerometer.times_s().iter().zip(readings).enumerate() {
            write!(out, "{t:?}")?;
            let celsius = temperature.and_then(|values| values.get(k));
            a.iter().chain(g).chain(celsius).try_for_each(|value| write!(out, ",{value:?}"))?;
            writeln!(out)?;
        }
        Ok(())
    })
}
