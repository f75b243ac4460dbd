//! The holds in the result: gravity's magnitude in them by the parameters of the whole IMU.
//!
//! Which holds are left out is decided by the accelerometer's own static fit. What is written of them is by the parameters of the least squares of
//! all, which rotations and known terms pull a little away from that fit.

use crate::error::Result;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::holds::magnitude_rms;
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::model::{ImuModel, State, singular};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::uncalibrated::Uncalibrated;
use crate::sensor::{Correction, ImuParameters, SensorKind};

/// The holds of a solution.
pub(crate) fn hold_results(
    problem: &ImuProblem<'_>,
    (first, temperature): (&InitialAccelerometer, &RecordingTemperature<'_>),
    numbers: &[usize],
    model: &ImuModel<'_>,
    state: &State,
) -> Result<HoldCalibration> {
    let mut holds = first.holds.clone();
    for (&j, force) in numbers.iter().zip(&state.forces) {
        holds.holds[j].force_mps2 = *force;
    }
    correct(&mut holds, &state.imu, temperature)?;
    // of faces the fit of these knows it
    if first.alignment.is_none() {
        let of_accelerometer = |k: &usize| model.quantities[*k].sensor_kind() == SensorKind::Accelerometer;
        let known = |k: &usize| model.prior.as_ref().is_some_and(|(_, weight)| weight[*k] > 0.0);
        let unknown = (0..model.quantities.len()).filter(of_accelerometer).filter(|k| !known(k)).count();
        holds.degrees_of_freedom = model.holds.len().saturating_sub(unknown);
    }
    holds.before = Uncalibrated::accelerometer(problem.accelerometer, &state.imu.accelerometer);
    Ok(holds)
}

/// Gives each hold what the accelerometer of an IMU makes of its mean. Its studentised residual stays that of the static fit, which alone knows how much of it a hold takes up itself.
fn correct(
    holds: &mut HoldCalibration,
    imu: &ImuParameters,
    temperature: &RecordingTemperature<'_>,
) -> Result<()> {
    for result in &mut holds.holds {
        let accelerometer = imu.at(temperature.of_hold(&result.hold)).accelerometer;
        let correction = Correction::of(&accelerometer).ok_or_else(singular)?;
        result.magnitude_residual_mps2 =
            correction.apply(&result.hold.mean).norm() - holds.gravity.magnitude_mps2;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
    Ok(())
}
