//! What is to be calibrated.

use super::holds::HoldsSetup;
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::CommandedMotion;
use crate::sensor::{Recording, Sensor};
use nalgebra::Vector3;

/// A sensor, a recording of it, and what is known of its stimulus.
#[derive(Debug, Clone, Copy)]
pub struct CalibrationProblem<'a> {
    /// The datasheet.
    pub sensor: &'a Sensor,
    /// The recording.
    pub recording: &'a Recording,
    /// The stimulus.
    pub stimulus: Stimulus<'a>,
}

/// What is known of the stimulus.
#[derive(Debug, Clone, Copy)]
pub enum Stimulus<'a> {
    /// A robot arm executed a commanded motion.
    Motion(&'a CommandedMotion),
    /// The sensor was held still in several orientations.
    Holds(&'a HoldsSetup),
}

/// An accelerometer that was held still in known directions.
#[derive(Debug, Clone, Copy)]
pub struct FacesProblem<'a> {
    /// The datasheet.
    pub sensor: &'a Sensor,
    /// The recording.
    pub recording: &'a Recording,
    /// The holds, with their intervals. The gauge is of no account: the directions are the true frame.
    pub holds: &'a HoldsSetup,
    /// Direction of the specific force (up) in each hold, in the true frame.
    pub directions: &'a [Vector3<f64>],
    /// Standard deviation of these directions, rad about each axis. `None`: it comes from the scatter of the holds.
    pub face_sd_rad: Option<f64>,
}

impl CalibrationProblem<'_> {
    /// Checks that the recording is one: at least two samples, finite, strictly increasing in time, of the sensor's axes and unit.
    pub(super) fn validate(&self) -> Result<()> {
        let recording = self.recording;
        let reject = |code: Refusal, message: String, help: &str| {
            Err(Error::recording(InputError::new(code, message, help)))
        };
        if recording.axes != self.sensor.axes {
            return reject(
                Refusal::ColumnMissing,
                format!("the recording has {} axes, the sensor {}", recording.axes, self.sensor.axes),
                "set `sensor.axes`, or record all axes",
            );
        }
        if recording.unit != self.sensor.unit {
            return reject(
                Refusal::UnitContradicted,
                format!(
                    "the recording is in {}, the sensor's readings in {}",
                    recording.unit.symbol(),
                    self.sensor.unit.symbol()
                ),
                "set `sensor.unit`, or give the recording's unit",
            );
        }
        sound(recording)
    }
}

/// Refuses a recording whose samples are none: too few, times that do not increase, readings that are no numbers.
pub(super) fn sound(recording: &Recording) -> Result<()> {
    let reject = |code: Refusal, message: String, help: &str| {
        Err(Error::recording(InputError::new(code, message, help)))
    };
    if recording.len() < 2 || recording.readings.len() != recording.len() {
        return reject(
            Refusal::RecordingShort,
            format!("the recording has {} samples", recording.len()),
            "record at least two",
        );
    }
    if let Some(k) =
        recording.times_s.windows(2).position(|pair| pair[1] <= pair[0] || !(pair[1] - pair[0]).is_finite())
    {
        return reject(
            Refusal::TimesNotIncreasing,
            format!("time does not increase after sample {k}"),
            "sort the samples, remove duplicates",
        );
    }
    if let Some(k) =
        recording.readings.iter().position(|y| y.iter().any(|y| !y.is_finite() || y.abs() > 1e12))
    {
        return reject(
            Refusal::ValueOutOfRange,
            format!(
                "sample {k}, at {:?} s, is not a usable reading: {:?}",
                recording.times_s[k],
                recording.readings[k].as_slice()
            ),
            "remove it",
        );
    }
    Ok(())
}
