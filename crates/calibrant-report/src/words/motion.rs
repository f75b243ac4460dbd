//! What is said of a calibration by a commanded motion.

use calibrant_core::diagnostic::Diagnostic;

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::SamplesOutsideMotion { outside, samples, motion_start_s, motion_end_s } => format!(
            "{outside} of {samples} samples lie outside the motion's {motion_start_s} to {motion_end_s} s and were not used"
        ),
        Diagnostic::MotionNotRecorded { empty_s, motion_s } => format!(
            "the recording has no sample in intervals that make up {:.0} % of the motion's {motion_s} s",
            100.0 * empty_s / motion_s
        ),
        Diagnostic::FitWorseThanNoise { p_value, noise_ratio, is_white } => {
            let consequence = if *is_white {
                "the standard deviations are too small by about that factor, or the motion was not the commanded one"
            } else {
                "the residuals are not white, so the error is systematic and may be far larger than the standard deviations: check that both \
                 clocks start together and run alike, and that the motion was the commanded one"
            };
            format!(
                "the fit is worse than the noise explains (χ² p-value {}; residual noise {noise_ratio:.3} times the assumed one): {consequence}",
                small(*p_value)
            )
        }
        Diagnostic::FitBetterThanNoise { p_value, noise_ratio } => format!(
            "the fit is better than the noise explains (χ² p-value {p_value:.4}; residual noise {noise_ratio:.3} times the assumed one): \
             the assumed noise is too large, and so are the standard deviations"
        ),
        Diagnostic::ResidualsNotWhite { axis, p_value } => format!(
            "the residuals of axis {axis} are not white (Ljung–Box p-value {}): something is left unmodelled",
            small(*p_value)
        ),
        Diagnostic::NothingToCheck { holds: None, .. } => {
            "there are as many unknowns as readings: nothing is left to check the fit with".into()
        }
        Diagnostic::EstimateBiased { parameter, deviations } => format!(
            "the joint estimate of motion and parameters is biased by about {deviations:.1} standard deviations in {parameter}: the process noise is large for \
             so many intervals; trust the standard deviations less, or calibrate on a shorter motion or with less process noise"
        ),
        Diagnostic::WeakerThanDatasheet { parameters } => format!(
            "the recording says less than the datasheet about {}: the standard deviation exceeds the datasheet's spread",
            parameters.join(", ")
        ),
        Diagnostic::ScaleNegative { axis } => {
            format!("the scale factor of axis {axis} is negative: is the axis reversed?")
        }
        _ => return None,
    })
}

/// A small probability in words: `1.2e-7`, or `below 1e-300` where the number underflows.
fn small(p: f64) -> String {
    if p < 1e-300 { "below 1e-300".into() } else { format!("{p:.1e}") }
}
