//! Warnings about a fit to a motion.

use super::context::Context;
use super::{Calibration, Error, Result, Trust};
use crate::diagnostic::datasheet::{GainImplausible, ScaleNegative, WeakerThanDatasheet};
use crate::diagnostic::fit::{
    EstimateBiased, FitBetterThanNoise, FitWorseThanNoise, ModelContradicted, NotConverged, NothingToCheck,
    ResidualsNotWhite,
};
use crate::diagnostic::motion::{MotionNotRecorded, SamplesOutsideMotion};
use crate::diagnostic::{Check, Diagnostic};
use crate::error::UndeterminedGroup;
use crate::estimate::CalibrationStatus;
use crate::estimate::datasheet::noise_implausible;
use crate::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use nalgebra::Vector3;

/// Warnings about a fit.
pub(super) fn warnings(context: &Context<'_>, calibration: &Calibration, bias: &[f64]) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    if calibration.status != CalibrationStatus::Converged {
        warnings.push(NotConverged { status: calibration.status.name() }.into());
    }
    let recorded = context.problem.recording.len();
    let used = context.positions.samples();
    // where the clock is estimated, the motion is looked for in the recording
    if used < recorded && context.command.clock.is_exact() {
        warnings.push(
            SamplesOutsideMotion {
                outside: recorded - used,
                samples: recorded,
                motion_start_s: context.command.motion.times_s()[0],
                motion_end_s: context.command.motion.times_s()[context.command.motion.intervals()],
            }
            .into(),
        );
    }
    if let (Some(p), Some(estimate)) = (calibration.fit.p_value, calibration.fit.noise_estimate) {
        let worst = context
            .problem
            .sensor
            .active_axes()
            .iter()
            .map(|axis| estimate[axis.index()] / context.noise[axis.index()])
            .fold(0.0, f64::max);
        if p < 1e-3 {
            let is_white = calibration.fit.whiteness.iter().all(|test| test.p_value >= 1e-4);
            warnings.push(FitWorseThanNoise { p_value: p, noise_ratio: worst, is_white }.into());
            warnings.extend(far_beyond_noise(&estimate, &context.noise, is_white));
        } else if p > 1.0 - 1e-3 {
            warnings.push(FitBetterThanNoise { p_value: p, noise_ratio: worst }.into());
        }
    }
    for (axis, test) in context.problem.sensor.active_axes().iter().zip(&calibration.fit.whiteness) {
        if test.p_value < 1e-4 {
            warnings.push(ResidualsNotWhite { axis: *axis, p_value: test.p_value }.into());
        }
    }
    warnings.extend(uncovered(context));
    if calibration.fit.degrees_of_freedom == 0 {
        let parameters = calibration.parameters.len();
        warnings.push(NothingToCheck { holds: None, parameters }.into());
    }
    warnings.extend(biased(calibration, bias));
    // a reversed axis says it better
    let is_reversed = |found: &Diagnostic| {
        found.code() == GainImplausible::CODE && found.number("gain").is_some_and(|gain| gain < 0.0)
    };
    warnings.extend(calibration.beyond_datasheet().into_iter().filter(|found| !is_reversed(found)));
    warnings.extend(weak(calibration));
    if let Some(axis) = negative_scale(calibration) {
        warnings.push(ScaleNegative { axis }.into());
    }
    warnings
}

/// Does a warning say that the motion was not the commanded one?
pub(super) fn is_of_another_motion(found: &Diagnostic) -> bool {
    [FitWorseThanNoise::CODE, ModelContradicted::CODE, ResidualsNotWhite::CODE].contains(&found.code())
}

/// Residuals that are more than ten times the given noise: of the noise itself if they are white, otherwise of the model.
fn far_beyond_noise(found: &Vector3<f64>, given: &Vector3<f64>, is_white: bool) -> Option<Diagnostic> {
    let sensor_kind = SensorKind::Accelerometer;
    let noise = noise_implausible(sensor_kind, found, given)?;
    Some(match is_white {
        true => noise.into(),
        false => ModelContradicted { sensor_kind, ratio: noise.ratio }.into(),
    })
}

/// Parameters that the recording determines less well than the datasheet.
fn weak(calibration: &Calibration) -> Option<Diagnostic> {
    let parameters: Vec<String> = calibration
        .parameters
        .iter()
        .zip(calibration.sd())
        .filter(|(parameter, sd)| parameter.spread.is_some_and(|spread| *sd > spread))
        .map(|(parameter, _)| parameter.name.clone())
        .collect();
    (!parameters.is_empty()).then_some(Diagnostic::from(WeakerThanDatasheet { parameters }))
}

fn negative_scale(calibration: &Calibration) -> Option<Axis> {
    Axis::ALL
        .into_iter()
        .find(|axis| calibration.imu[SensorKind::Accelerometer].matrix[(axis.index(), axis.index())] < 0.0)
}

/// Motion that was not recorded.
fn uncovered(context: &Context<'_>) -> Option<Diagnostic> {
    let motion = &context.command.motion;
    let tau = motion.times_s();
    let empty: f64 = (0..motion.intervals())
        .filter(|&i| context.positions.interval_samples(i).is_empty())
        .map(|i| motion.interval_s(i))
        .sum();
    let whole = tau[motion.intervals()] - tau[0];
    let uncovered = Diagnostic::from(MotionNotRecorded { empty_s: empty, motion_s: whole });
    (empty > 0.1 * whole && context.positions.samples() >= motion.intervals()).then_some(uncovered)
}

/// The warning about biased estimates, for a noisy motion of many intervals.
fn biased(calibration: &Calibration, bias: &[f64]) -> Option<Diagnostic> {
    let sd = calibration.sd();
    let (k, times) = bias
        .iter()
        .zip(&sd)
        .map(|(bias, sd)| (bias / sd).abs())
        .enumerate()
        .filter(|(_, times)| times.is_finite())
        .max_by(|one, other| one.1.total_cmp(&other.1))?;
    let parameter = calibration.parameters[k].name.clone();
    (times > 0.3).then_some(Diagnostic::from(EstimateBiased { parameter, deviations: times }))
}

/// Does each axis respond to the motion at all?
///
/// # Errors
/// [`Error::NotIdentifiable`] if a scale factor is zero within its noise. No correction exists then.
pub(super) fn respond(context: &Context<'_>, calibration: &Calibration) -> Result<()> {
    let sd = calibration.sd();
    for &axis in context.problem.sensor.active_axes() {
        let scale = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Scale(axis));
        let Some(k) = calibration.quantities.iter().position(|quantity| *quantity == scale) else {
            continue;
        };
        if calibration.values[k].abs() < 3.0 * sd[k] && calibration.status == CalibrationStatus::Converged {
            let noisy = matches!(context.command.trust, Trust::Noisy(_));
            return Err(Error::undetermined(UndeterminedGroup {
                parameters: vec![Quantity::Scale(axis).name_in_results()],
                free_combinations: 1,
                reason: format!(
                    "the reading of axis {axis} does not follow the motion: the scale factor is zero within its noise{}",
                    if noisy { ", or the process noise is too large for this motion" } else { "" }
                ),
                remedy: "check the wiring, the order of the axes and the clocks of recording and motion"
                    .into(),
            }));
        }
    }
    Ok(())
}
