//! A gyroscope in deg/s whose readings are taken for rad/s.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::alignment::coarse_rotations::CoarseRotations;
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::SensorKind;

/// Refuses readings with which gravity is missed by half as much where they are in deg/s. `median_rad`: by what it is missed in rad/s.
pub(crate) fn check(model: &ImuModel<'_>, state: &State, median_rad: f64) -> Result<()> {
    let per_degree = state.imu[SensorKind::Gyroscope].matrix * (180.0 / std::f64::consts::PI);
    let so_read = CoarseRotations::of(model, state).judge(&per_degree);
    if !so_read.is_some_and(|look| look.median_rad < 0.5 * median_rad) {
        return Ok(());
    }
    let degrees = median_rad.to_degrees();
    Err(Error::recording(InputError::new(
        Refusal::UnitImplausible,
        format!(
            "the gyroscope's readings are in deg/s, not rad/s: so read, the rotations miss gravity by {degrees:.0}°"
        ),
        "say that the gyroscope is in deg/s",
    )))
}
