//! What a user should know about a fit, in words.

use super::Calibration;
use super::chain::Context;
use crate::estimate::CalibrationStatus;
use crate::estimate::statistics::{implausible, small};
use crate::sensor::Axis;

/// Warnings about a fit.
pub(super) fn warnings(context: &Context<'_>, calibration: &Calibration) -> Vec<String> {
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
            warnings.push(format!(
                "the fit is worse than the noise explains (χ² p-value {}; residual noise {worst:.3} times the assumed one): \
                 the standard deviations are too small by about that factor, or the motion was not the commanded one",
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
