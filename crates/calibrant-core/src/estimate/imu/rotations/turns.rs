//! Turns of known angle, with the integrals of the gyroscope's readings.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::model::{GyroscopeNoise, TurnData};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::rotations::spans::Integrable;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::motion::turn_axis_sd_rad;
use crate::sensor::{ImuParameters, SensorKind};
use nalgebra::Vector3;
use std::ops::Range;

/// The turns of known angle, with the integrals of the readings.
pub(crate) fn turn_data(
    problem: &ImuProblem<'_>,
    integrable: &Integrable<'_>,
    noise: &GyroscopeNoise,
    felt: Option<&[Vector3<f64>]>,
    (start, temperature): (&ImuParameters, &RecordingTemperature<'_>),
) -> Result<Vec<TurnData>> {
    problem
        .setup
        .turns
        .iter()
        .enumerate()
        .map(|(number, turn)| {
            let gyroscope = integrable.gyroscope;
            if let Some(before) = problem.setup.turns[..number].iter().position(|before| turn.repeats(before))
            {
                return Err(Error::experiment(InputError::new(
                    Refusal::HoldsInvalid,
                    format!(
                        "{} and {} are the same turn: it would count twice",
                        problem.setup.turns[before].span(before),
                        turn.span(number)
                    ),
                    "give each turn once, in gyroscope.turns or in the list of sections",
                )));
            }
            let Range { start: first, end } = gyroscope.between(turn.start_s, turn.end_s);
            if end < first + 3 {
                return Err(Error::recording(InputError::new(
                    Refusal::HoldsInvalid,
                    format!("{} has {} samples of the gyroscope", turn.span(number), end - first),
                    "correct the times of the turns",
                )));
            }
            if let Some(saturation) = integrable.saturation(&(first..end)) {
                return Err(Error::recording(InputError::new(
                    Refusal::ReadingsSaturated,
                    format!("{} cannot be integrated: {saturation}", turn.span(number)),
                    "turn more slowly, record with a larger range, or take this turn out",
                )));
            }
            let (times, readings) = (&gyroscope.times_s[first..end], &gyroscope.readings[first..end]);
            let (mut integral, mut variance, mut force) =
                (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
            for k in 0..times.len() {
                let before = if k > 0 { times[k] - times[k - 1] } else { 0.0 };
                let after = if k + 1 < times.len() { times[k + 1] - times[k] } else { 0.0 };
                let weight = 0.5 * (before + after);
                integral += readings[k] * weight;
                force += felt.map_or_else(Vector3::zeros, |felt| felt[first + k]) * weight;
                variance += noise.of_sample.component_mul(&noise.of_sample) * (weight * weight);
            }
            let duration_s = times[times.len() - 1] - times[0];
            // an axis that hardly turns reads as in a hold
            variance += noise.of_mean * (duration_s * duration_s);
            // a rough gain: the integral of the readings beyond their bias, over the angle
            let temperature_c = temperature.mean(turn.start_s, turn.end_s);
            let bias = start.at(temperature_c)[SensorKind::Gyroscope].bias * duration_s;
            let gain = (integral - bias).norm() / turn.angle_rad.abs();
            let along = (integral - bias).try_normalize(0.0).unwrap_or_default().map(|share| share * share);
            let axis_sd_rad = turn_axis_sd_rad(turn.angle_rad, turn.angle_sd_rad, turn.axis_sd_rad);
            let across = (Vector3::repeat(1.0) - along) * (axis_sd_rad * turn.angle_rad).powi(2);
            variance += (along * turn.angle_sd_rad.powi(2) + across) * gain.powi(2);
            Ok(TurnData {
                integral,
                duration_s,
                force,
                angle: turn.axis * turn.angle_rad,
                weight: variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)),
                temperature_c,
            })
        })
        .collect()
}
