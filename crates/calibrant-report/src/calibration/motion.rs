//! The sections on a recovered motion and on its residuals.

use crate::About;
use crate::figure::{
    acceleration_figure, autocorrelations, histograms, motion_error_figure, residuals_over_time,
    state_and_jerk_figure,
};
use crate::html::Page;
use calibrant_core::estimate::{Calibration, RecoveredMotion};
use calibrant_core::sensor::ImuRecording;

/// The estimated motion, with the true one if it is known.
pub(super) fn motion_section(
    calibration: &Calibration,
    recovered: &RecoveredMotion,
    recording: &ImuRecording,
    about: &About,
) -> Page {
    let mut page = Page::default();
    let lead = match recovered.trust {
        "known" => "Trust known: the motion is the commanded one, and not estimated.",
        "noisy" => {
            "Trust noisy: the motion is the commanded one plus process noise. It was estimated with the parameters."
        }
        "unknown" => {
            "Trust unknown: only the acceleration at both ends was given. The motion in between was estimated with the parameters."
        }
        _ => "",
    };
    page.section("Motion", lead);
    let Some(recording) = &recording.accelerometer else { return page };
    let truth = about.true_motion.as_ref();
    let title = match truth {
        Some(_) => "Actual, measured and estimated acceleration (Figure 4 of the thesis)",
        None => "Measured and estimated acceleration (Figure 4 of the thesis)",
    };
    page.push(acceleration_figure(title, calibration, recovered, recording, truth).html());
    if let Some(figure) = motion_error_figure(recovered, recording, truth) {
        page.push(figure.html());
    }
    let title = match truth {
        Some(_) => "Actual and estimated states and inputs (Figure 5 of the thesis)",
        None => "Estimated states and inputs (Figure 5 of the thesis)",
    };
    page.push(state_and_jerk_figure(title, recovered, recording, truth).html());
    page
}

/// The residuals: readings less the model.
pub(super) fn residual_section(
    page: &mut Page,
    calibration: &Calibration,
    recovered: &RecoveredMotion,
    recording: &ImuRecording,
) {
    let Some(recording) = &recording.accelerometer else { return };
    page.section("Residuals", "");
    page.push(residuals_over_time(calibration, recovered, recording).html());
    page.push(histograms(calibration, recovered, recording).html());
    page.push(autocorrelations(calibration, recovered, recording).html());
}
