//! Sentences about a calibration by a commanded motion.

use calibrant_core::diagnostic::Diagnostic;

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::SamplesOutsideMotion { outside, samples, motion_start_s, motion_end_s } => format!(
            "{outside} of {samples} samples lie outside the motion, {motion_start_s} to {motion_end_s} s. They are not used."
        ),
        Diagnostic::MotionNotRecorded { empty_s, motion_s } => format!(
            "the recording has no samples in {:.0} % of the motion's {motion_s} s. Record the whole motion.",
            100.0 * empty_s / motion_s
        ),
        Diagnostic::FitWorseThanNoise { p_value, noise_ratio, is_white } => {
            let consequence = if *is_white {
                "The standard deviations are too small by about that factor, or the motion was not the commanded one."
            } else {
                "The residuals are not white: the error is systematic, and may be far larger than the standard deviations. \
                 Check that both clocks start together and run at one rate. Check that the motion was the commanded one."
            };
            format!(
                "the fit is worse than the noise explains (χ² p-value {}, residual noise {noise_ratio:.3} times the assumed noise). {consequence}",
                small(*p_value)
            )
        }
        Diagnostic::FitBetterThanNoise { p_value, noise_ratio } => format!(
            "the fit is better than the noise explains (χ² p-value {p_value:.4}, residual noise {noise_ratio:.3} times the assumed noise). \
             The assumed noise is too large, and the standard deviations are too large with it. Correct sensor.noise_mps2."
        ),
        Diagnostic::ResidualsNotWhite { axis, p_value } => format!(
            "the residuals of axis {axis} are not white (Ljung–Box p-value {}). The model does not explain all of the signal. Check clocks and motion.",
            small(*p_value)
        ),
        Diagnostic::NothingToCheck { holds: None, .. } => {
            "the model has as many unknowns as there are readings. No data are left to check the fit.".into()
        }
        Diagnostic::EstimateBiased { parameter, deviations } => format!(
            "the estimate of {parameter} is biased by about {deviations:.1} standard deviations. The process noise is large for the number of intervals. \
             Calibrate on a shorter motion, or with less process noise."
        ),
        Diagnostic::WeakerThanDatasheet { parameters } => format!(
            "the recording determines {} less well than the datasheet: the standard deviation exceeds the datasheet's spread",
            parameters.join(", ")
        ),
        Diagnostic::ScaleNegative { axis } => {
            format!("the scale factor of axis {axis} is negative. Is the axis reversed?")
        }
        _ => return None,
    })
}

/// A small probability in words: `1.2e-7`, or `below 1e-300` where the number underflows.
fn small(p: f64) -> String {
    if p < 1e-300 { "below 1e-300".into() } else { format!("{p:.1e}") }
}
