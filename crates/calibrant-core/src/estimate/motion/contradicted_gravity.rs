//! Is the gravity of the readings the one that was given? If not, the biases take it up, and look precise.
//!
//! The constant force that the biases stand for is `c = S⁻¹ (b − b_nominal)`. It is judged where it is far
//! beyond what the datasheet, the tilt and the estimate allow a bias. Then `γ + c`, the constant force of the
//! readings, shows one of three faults: gravity where none was given, none where it was given, or gravity in
//! another direction.

use super::context::Context;
use super::{Calibration, Error, Result};
use crate::error::{InputError, Refusal};
use crate::sensor::{Axis, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Gravity on Earth, m/s².
const EARTH: f64 = 9.806_65;
/// Part of gravity within which a force is gravity, or none.
const NEAR: f64 = 0.1;
/// Number of standard deviations that no bias reaches.
const FAR: f64 = 6.0;
/// Part of gravity below which a bias is only a bias.
const LEAST: f64 = 0.25;
/// The same where the datasheet gives no spread of the biases.
const LEAST_WITHOUT_SPREAD: f64 = 0.5;
/// Part of gravity above which the residuals show another motion, whose biases say nothing.
const SCATTER: f64 = 0.05;
/// Angle within which a force lies along an axis, degrees.
const ALONG: f64 = 15.0;

/// Checks the biases of a calibration for gravity.
///
/// # Errors
/// [`Error::Recording`] with [`Refusal::GravityContradicted`].
pub(super) fn check(context: &Context<'_>, calibration: &Calibration) -> Result<()> {
    let sensor = context.problem.sensor;
    let (axes, given) = (sensor.axes, context.command.gravity);
    let active = |v: Vector3<f64>| Vector3::from_fn(|k, _| if k < axes { v[k] } else { 0.0 });
    let accelerometer = &calibration.imu[SensorKind::Accelerometer];
    let (Some(offset), Some(inverse)) = (sensor.offset, accelerometer.matrix.try_inverse()) else {
        return Ok(());
    };
    let constant = active(inverse * (accelerometer.bias - offset));
    if constant.norm() < allowed(context, calibration, &inverse) {
        return Ok(());
    }
    let force = active(given.map_or_else(Vector3::zeros, |gravity| gravity.force_mps2)) + constant;
    let g = given.map_or(EARTH, |gravity| gravity.force_mps2.norm());
    if scatter(context, calibration, &inverse) > SCATTER * g {
        return Ok(());
    }
    let is_gravity = (force.norm() - g).abs() <= NEAR * g;
    let refuse = |message: String, help: String| {
        let input_error = InputError::new(Refusal::GravityContradicted, message, help);
        Err(Error::recording(input_error.about_key("motion.gravity_mps2")))
    };
    match given {
        None if is_gravity => {
            let large = if sensor.bias_sd_mps2.is_some() {
                "; if a bias really is this large, give its spread in sensor.bias_sd_mps2"
            } else {
                ""
            };
            refuse(
                format!(
                    "the readings contain gravity {}, which [motion] does not give: without it the bias would be {} m/s²",
                    place(&force),
                    numbers(&constant, axes)
                ),
                format!("give gravity_mps2 = {} in [motion]{large}", suggestion(&force, g, axes)),
            )
        }
        Some(_) if force.norm() <= NEAR * g => refuse(
            format!(
                "[motion] gives gravity, which the readings do not contain: with it the bias would be {} m/s²",
                numbers(&constant, axes)
            ),
            "give the sensor's own readings, from which no program has taken gravity, or leave gravity out of [motion]"
                .into(),
        ),
        Some(_) if is_gravity => refuse(
            format!(
                "gravity in the readings is {} and not where [motion] gives it: the bias would be {} m/s²",
                place(&force),
                numbers(&constant, axes)
            ),
            format!(
                "correct gravity_mps2 = {} in [motion]; if only the sensor is askew, raise tilt_sd_deg",
                suggestion(&force, g, axes)
            ),
        ),
        _ => Ok(()),
    }
}

/// The largest constant force that passes for a bias, m/s².
fn allowed(context: &Context<'_>, calibration: &Calibration, inverse: &Matrix3<f64>) -> f64 {
    let sensor = context.problem.sensor;
    let gravity = context.command.gravity;
    let g = gravity.map_or(EARTH, |gravity| gravity.force_mps2.norm());
    let Some(spread) = sensor.bias_sd_mps2 else { return LEAST_WITHOUT_SPREAD * g };
    let sd = calibration.sd();
    // the covariance contains the tilt already
    let estimate: f64 = (0..sensor.axes).map(|k| (inverse[(k, k)] * sd[k]).powi(2)).sum();
    let spread: f64 = (0..sensor.axes).map(|k| spread[k] * spread[k]).sum();
    (FAR * (estimate + spread).sqrt()).max(LEAST * g)
}

/// Root mean square of the residuals on the worst axis, m/s².
fn scatter(context: &Context<'_>, calibration: &Calibration, inverse: &Matrix3<f64>) -> f64 {
    let rms = calibration.fit.residual_rms.unwrap_or_default();
    let of_axis = |k: usize| (inverse[(k, k)] * rms[k]).abs();
    (0..context.problem.sensor.axes).map(of_axis).fold(0.0, f64::max)
}

/// The axis along which a force lies, if it does.
fn axis_of(force: &Vector3<f64>) -> Option<(Axis, f64)> {
    let k = force.iamax();
    let along = force[k].abs() >= ALONG.to_radians().cos() * force.norm();
    along.then(|| (Axis::ALL[k], force[k].signum()))
}

fn place(force: &Vector3<f64>) -> String {
    match axis_of(force) {
        Some((axis, sign)) => format!("on axis {}{axis}", if sign < 0.0 { "-" } else { "" }),
        None => format!("of ({}) m/s²", numbers(force, 3)),
    }
}

fn numbers(v: &Vector3<f64>, axes: usize) -> String {
    let all: Vec<String> = v.iter().take(axes).map(|value| format!("{value:.2}")).collect();
    all.join(", ")
}

/// The value of the key, as TOML.
fn suggestion(force: &Vector3<f64>, g: f64, axes: usize) -> String {
    let v = axis_of(force).map_or(*force, |(axis, sign)| Vector3::ith(axis.index(), sign * g));
    let show = |value: f64| {
        let rounded = (value * 1e5).round() / 1e5 + 0.0;
        format!("{rounded:?}")
    };
    if axes == 1 {
        return show(v.x);
    }
    format!("[{}]", v.iter().map(|value| show(*value)).collect::<Vec<_>>().join(", "))
}
