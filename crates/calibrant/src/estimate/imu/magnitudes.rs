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

/// Gives each hold what the accelerometer of an IMU makes of its mean. The deviation that is expected of it stays that of the static fit.
pub(super) fn correct(holds: &mut HoldCalibration, imu: &ImuParameters, climate: &Climate<'_>) -> Result<()> {
    for result in &mut holds.holds {
        let accelerometer = imu.at(climate.of_hold(&result.hold)).accelerometer;
        let correction = Correction::of(&accelerometer).ok_or_else(singular)?;
        let residual = correction.apply(&result.hold.mean).norm() - holds.gravity.magnitude_mps2;
        let per_deviation = result.studentised_residual / result.magnitude_residual_mps2;
        if per_deviation.is_finite() {
            result.studentised_residual = per_deviation * residual;
        }
        result.magnitude_residual_mps2 = residual;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
    Ok(())
}
