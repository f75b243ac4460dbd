//! The holds in the result, with gravity residuals by the parameters of the whole IMU.
//!
//! The accelerometer's static fit decides which holds are used. The residuals in the result use the parameters of the whole least squares. Rotations and
//! known terms move these slightly away from the static fit.

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
    // for faces, their own fit determines it
    if first.alignment.is_none() {
        let of_accelerometer = |k: &usize| model.quantities[*k].sensor_kind() == SensorKind::Accelerometer;
        let known = |k: &usize| model.prior.as_ref().is_some_and(|(_, weight)| weight[*k] > 0.0);
        let unknown = (0..model.quantities.len()).filter(of_accelerometer).filter(|k| !known(k)).count();
        holds.degrees_of_freedom = model.holds.len().saturating_sub(unknown);
    }
    holds.before = Uncalibrated::accelerometer(problem.accelerometer, &state.imu[SensorKind::Accelerometer]);
    Ok(holds)
}

/// Sets the corrected mean and the gravity residual of each hold. The studentised residual stays that of the static fit, since only that fit knows the
/// influence of a hold on itself.
fn correct(
    holds: &mut HoldCalibration,
    imu: &ImuParameters,
    temperature: &RecordingTemperature<'_>,
) -> Result<()> {
    for result in &mut holds.holds {
        let accelerometer = imu.at(temperature.of_hold(&result.hold))[SensorKind::Accelerometer];
        let correction = Correction::of(&accelerometer).ok_or_else(singular)?;
        result.magnitude_residual_mps2 =
            correction.apply(&result.hold.mean).norm() - holds.gravity.magnitude_mps2;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
    Ok(())
}
