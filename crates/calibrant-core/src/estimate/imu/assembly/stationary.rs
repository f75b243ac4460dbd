//! The gyroscope in the stationary intervals, in the result.

use crate::error::Result;
use crate::estimate::imu::model::{GyroscopeNoise, HoldData, ImuModel, State, singular};
use crate::estimate::imu::result::GyroscopeInHolds;
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::sensor::{Correction, ImuParameters, SensorKind};
use nalgebra::Vector3;

/// Its mean rates and noise there. `numbers`: of the used holds. `before`: the IMU before its calibration. `vertical_rate`: the Earth's rate about the vertical over gravity, if known.
pub(crate) fn stationary_result(
    model: &ImuModel<'_>,
    (state, between): (&State, &Vector3<f64>),
    (gyroscope, numbers): (&StationaryGyroscope, &[usize]),
    before: &ImuParameters,
    vertical_rate: f64,
) -> Result<GyroscopeInHolds> {
    let rms = |imu: &ImuParameters| rate_rms(model, &state.forces, imu, vertical_rate).ok_or_else(singular);
    Ok(GyroscopeInHolds {
        noise: model.gyroscope_noise.of_sample,
        noise_source: gyroscope.noise_source,
        within_holds_sd: GyroscopeNoise::of(gyroscope.scatter, &gyroscope.coarse).of_sample,
        between_holds_sd: between_holds_sd(model, state, between),
        turning_holds: gyroscope.turning_places().map(|place| numbers[place]).collect(),
        rate_rms_radps: rms(&state.imu)?,
        rate_rms_before_radps: rms(before)?,
    })
}

/// The between-hold scatter, with the part from the unknown Earth's rate.
fn between_holds_sd(model: &ImuModel<'_>, state: &State, between: &Vector3<f64>) -> Vector3<f64> {
    let found = |(j, hold): (usize, &HoldData)| {
        let rate = model.earth.rate_found(j, &state.forces[j]);
        (state.imu.at(hold.temperature_c)[SensorKind::Gyroscope].matrix * rate)
            .map(|reading| reading * reading)
    };
    let squares: Vector3<f64> = model.holds.iter().enumerate().map(found).sum();
    (squares / model.holds.len() as f64 + between.component_mul(between)).map(f64::sqrt)
}

/// Root mean square over the holds of the gyroscope's mean rate. `None` if its matrix is singular.
fn rate_rms(
    model: &ImuModel<'_>,
    forces: &[Vector3<f64>],
    imu: &ImuParameters,
    vertical_rate: f64,
) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for (hold, force) in model.holds.iter().zip(forces) {
        let Some((mean, _)) = &hold.gyroscope else { continue };
        let correction = Correction::of(&imu.at(hold.temperature_c)[SensorKind::Gyroscope])?;
        let rate = correction.apply(&(mean - imu.g_sensitivity * force));
        sum += (rate - force * vertical_rate).norm_squared();
        count += 1;
    }
    Some((sum / f64::from(count.max(1))).sqrt())
}
