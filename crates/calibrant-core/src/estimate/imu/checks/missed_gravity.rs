//! Gravity that half of the rotations miss, whatever the gyroscope's matrix.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::imu::alignment::coarse_rotations::WRONG_RAD;
use crate::estimate::imu::checks::{axes_without_rotation, common_factor, gyroscope_unit};
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::ReadingUnit;

/// Holds that scatter by more than this share of gravity are none.
const MOVING_SHARE: f64 = 0.005;

/// Condition number of the holds from which on the accelerometer's directions say nothing of the gyroscope.
const UNDETERMINED: f64 = 1e4;

/// Refuses readings that cannot be angular rates in the unit given.
pub(crate) fn check(
    model: &ImuModel<'_>,
    state: &State,
    median_rad: f64,
    unit: ReadingUnit,
    holds: &HoldCalibration,
) -> Result<()> {
    if median_rad <= WRONG_RAD {
        return Ok(());
    }
    let degrees = median_rad.to_degrees();
    let message = format!(
        "half of the rotations miss gravity by more than {degrees:.0}°: the gyroscope's readings do not fit the accelerometer's"
    );
    if holds.condition_number > UNDETERMINED {
        let message = format!(
            "{message}, but the holds hardly determine the accelerometer (condition number {:.0}): what is wrong cannot be told",
            holds.condition_number
        );
        let help = "hold the sensor still in at least 14 well-spread orientations, each axis up, down and in between";
        return Err(Error::recording(InputError::new(Refusal::GravityMissed, message, help)));
    }
    if unit == ReadingUnit::RadianPerSecond {
        gyroscope_unit::check(model, state, median_rad)?;
        common_factor::check(model, state, median_rad)?;
    }
    axes_without_rotation::check(model, state)?;
    let scatter = holds.between_holds_sd_mps2;
    if scatter > MOVING_SHARE * model.gravity {
        let message = format!(
            "{message}, and the holds themselves scatter by {:.0} mm/s² beyond their noise",
            1e3 * scatter
        );
        let help = "was the sensor still in them? they are the calmest parts of the recording (holds.minimum_hold_s, holds.intervals_s)";
        return Err(Error::recording(InputError::new(Refusal::GravityMissed, message, help)));
    }
    Err(Error::recording(InputError::new(
        Refusal::GravityMissed,
        message,
        "do both files belong to one recording, with one clock? are the axes of the gyroscope those of the accelerometer? does the gyroscope saturate?",
    )))
}
