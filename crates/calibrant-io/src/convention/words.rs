//! Words that all formats share.

use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// Program and version, for the first line of a file.
pub(super) fn written_by() -> String {
    format!("written by calibrant {}", env!("CARGO_PKG_VERSION"))
}

/// An input error without a place.
pub(super) fn input_error(code: Refusal, message: impl Into<String>, help: &str) -> Box<InputError> {
    Box::new(InputError::new(code, message, help))
}

/// The error for a file that is no calibration, or contradicts itself.
pub(super) fn invalid(message: impl Into<String>, help: &str) -> Box<InputError> {
    input_error(Refusal::CalibrationInvalid, message, help)
}

/// The error for a matrix that has no inverse.
pub(super) fn singular(sensor_kind: SensorKind) -> Box<InputError> {
    let message = format!("the matrix of the {sensor_kind} is singular");
    input_error(Refusal::CalibrationUnusable, message, "calibrate again")
}

/// The unit of a sensor's readings of this symbol, its own or counts.
pub(super) fn unit_named(symbol: &str, sensor_kind: SensorKind) -> Option<ReadingUnit> {
    [sensor_kind.stimulus_unit(), ReadingUnit::Counts].into_iter().find(|unit| unit.symbol() == symbol)
}
