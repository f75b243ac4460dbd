//! The magnitude of gravity in the holds, by the parameters of the whole IMU.
//!
//! Which holds are left out is decided by the accelerometer's own static fit. What is said of them is of the parameters that are written: those of the joint problem, which rotations and known
//! terms pull a little away from that fit.

use super::solver::singular;
use super::thermal::Climate;
use crate::error::Result;
use crate::estimate::HoldCalibration;
use crate::estimate::holds::magnitude_rms;
use crate::sensor::{Correction, ImuParameters};

/// Gives each hold what the accelerometer of an IMU makes of its mean. Its studentised residual stays that of the static fit, which alone knows how much of it a hold takes up itself.
pub(super) fn correct(holds: &mut HoldCalibration, imu: &ImuParameters, climate: &Climate<'_>) -> Result<()> {
    for result in &mut holds.holds {
        let accelerometer = imu.at(climate.of_hold(&result.hold)).accelerometer;
        let correction = Correction::of(&accelerometer).ok_or_else(singular)?;
        result.magnitude_residual_mps2 =
            correction.apply(&result.hold.mean).norm() - holds.gravity.magnitude_mps2;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
    Ok(())
}
