//! What a user should know about a fit, in words.

use super::context::Context;
use super::{Calibration, Error, Result, Trust};
use crate::error::UndeterminedGroup;
use crate::estimate::CalibrationStatus;
use crate::estimate::statistics::{implausible, small};
use crate::sensor::Axis;

/// Warnings about a fit.
pub(super) fn warnings(context: &Context<'_>, calibration: &Calibration, bias: &[f64]) -> Vec<String> {
    let mut warnings = Vec::new();
    if calibration.status != CalibrationStatus::Converged {
        warnings.push(format!(
            "the iteration did not converge ({}): the numbers are the best found, not the optimum",
            calibration.status.name()
        ));
    }
    let recorded = context.problem.recording.len();
    let used = context.positions.samples();
    if used < recorded {
        warnings.push(format!(
            "{} of {recorded} samples lie outside the motion's {} to {} s and were not used",
            recorded - used,
            context.command.motion.times_s()[0],
            context.command.motion.times_s()[context.command.motion.intervals()]
        ));
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
            let white = calibration.fit.whiteness.iter().all(|test| test.p_value >= 1e-4);
            let consequence = if white {
                "the standard deviations are too small by about that factor, or the motion was not the commanded one"
            } else {
                "the residuals are not white, so the error is systematic and may be far larger than the standard deviations: check that both \
                 clocks start together and run alike, and that the motion was the commanded one"
            };
            warnings.push(format!(
                "the fit is worse than the noise explains (χ² p-value {}; residual noise {worst:.3} times the assumed one): {consequence}",
                small(p)
            ));
        } else if p > 1.0 - 1e-3 {
            warnings.push(format!(
                "the fit is better than the noise explains (χ² p-value {p:.4}; residual noise {worst:.3} times the assumed one): \
                 the assumed noise is too large, and so are the standard deviations"
            ));
        }
    }
    for (axis, test) in context.problem.sensor.active_axes().iter().zip(&calibration.fit.whiteness) {
        if test.p_value < 1e-4 {
            warnings.push(format!(
                "the residuals of axis {axis} are not white (Ljung–Box p-value {}): something is left unmodelled",
                small(test.p_value)
            ));
        }
    }
    warnings.extend(uncovered(context));
    if calibration.fit.degrees_of_freedom == 0 {
        warnings.push("there are as many unknowns as readings: nothing is left to check the fit with".into());
    }
    warnings.extend(biased(calibration, bias));
    warnings.extend(implausible(calibration));
    warnings.extend(weak(calibration));
    if let Some(axis) = negative_scale(calibration) {
        warnings.push(format!("the scale factor of axis {axis} is negative: is the axis reversed?"));
    }
    warnings
}

/// Parameters of which the recording says less than the datasheet.
fn weak(calibration: &Calibration) -> Option<String> {
    let names: Vec<_> = calibration
        .parameters
        .iter()
        .zip(calibration.sd())
        .filter(|(parameter, sd)| parameter.spread.is_some_and(|spread| *sd > spread))
        .map(|(parameter, _)| parameter.name.as_str())
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "the recording says less than the datasheet about {}: the standard deviation exceeds the datasheet's spread",
            names.join(", ")
        )
    })
}

fn negative_scale(calibration: &Calibration) -> Option<Axis> {
    Axis::ALL.into_iter().find(|axis| calibration.sensor.matrix[(axis.index(), axis.index())] < 0.0)
}

/// Motion that was not recorded.
fn uncovered(context: &Context<'_>) -> Option<String> {
    let motion = &context.command.motion;
    let tau = motion.times_s();
    let empty: f64 = (0..motion.intervals())
        .filter(|&i| context.positions.interval_samples(i).is_empty())
        .map(|i| motion.interval_s(i))
        .sum();
    let whole = tau[motion.intervals()] - tau[0];
    (empty > 0.1 * whole && context.positions.samples() >= motion.intervals()).then(|| {
        format!(
            "the recording has no sample in intervals that make up {:.0} % of the motion's {whole} s",
            100.0 * empty / whole
        )
    })
}

/// A noisy motion of many intervals biases the joint estimate.
fn biased(calibration: &Calibration, bias: &[f64]) -> Option<String> {
    let sd = calibration.sd();
    let (k, times) = bias
        .iter()
        .zip(&sd)
        .map(|(bias, sd)| (bias / sd).abs())
        .enumerate()
        .filter(|(_, times)| times.is_finite())
        .max_by(|one, other| one.1.total_cmp(&other.1))?;
    (times > 0.3).then(|| {
        format!(
            "the joint estimate of motion and parameters is biased by about {times:.1} standard deviations in {}: the process noise is large for \
             so many intervals; trust the standard deviations less, or calibrate on a shorter motion or with less process noise",
            calibration.parameters[k].name
        )
    })
}

/// Does each axis respond to the motion at all?
///
/// # Errors
/// [`Error::NotIdentifiable`] where a scale factor is zero within its noise, so that no correction exists.
pub(super) fn respond(context: &Context<'_>, calibration: &Calibration) -> Result<()> {
    let sd = calibration.sd();
    for &axis in context.problem.sensor.active_axes() {
        let name = format!("scale.{axis}");
        let Some(k) = calibration.parameters.iter().position(|parameter| parameter.name == name) else {
            continue;
        };
        if calibration.values[k].abs() < 3.0 * sd[k] && calibration.status == CalibrationStatus::Converged {
            let noisy = matches!(context.command.trust, Trust::Noisy(_));
            return Err(Error::undetermined(UndeterminedGroup {
                parameters: vec![name],
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
