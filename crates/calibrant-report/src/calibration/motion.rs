//! The sections on a recovered motion and on its residuals.

use crate::About;
use crate::figure::{
    acceleration_figure, autocorrelations, histograms, motion_error_figure, residuals_over_time,
    state_and_jerk_figure,
};
use crate::sheet::Section;
use calibrant_core::estimate::{Calibration, RecoveredMotion};
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// The estimated motion, with the true one if it is known.
pub(super) fn motion_section<'a>(
    calibration: &'a Calibration,
    recovered: &'a RecoveredMotion,
    recording: &'a ImuRecording,
    about: &'a About,
) -> Section<'a> {
    let mut section = Section::on_page("Motion").lead(match recovered.trust {
        "known" => "Trust known: the motion is the commanded one, and not estimated.",
        "noisy" => {
            "Trust noisy: the motion is the commanded one plus process noise. It was estimated with the parameters."
        }
        "unknown" => {
            "Trust unknown: only the acceleration at both ends was given. The motion in between was estimated with the parameters."
        }
        _ => "",
    });
    let Some(recording) = &recording[SensorKind::Accelerometer] else { return section };
    let truth = about.true_motion.as_ref();
    let title = match truth {
        Some(_) => "Actual, measured and estimated acceleration (Figure 4 of the thesis)",
        None => "Measured and estimated acceleration (Figure 4 of the thesis)",
    };
    section.figure(move || Some(acceleration_figure(title, calibration, recovered, recording, truth)));
    section.figure(move || motion_error_figure(recovered, recording, truth));
    let title = match truth {
        Some(_) => "Actual and estimated states and inputs (Figure 5 of the thesis)",
        None => "Estimated states and inputs (Figure 5 of the thesis)",
    };
    section.figure(move || Some(state_and_jerk_figure(title, recovered, recording, truth)));
    section
}

/// The residuals: readings less the model.
pub(super) fn residual_section<'a>(
    calibration: &'a Calibration,
    recovered: &'a RecoveredMotion,
    recording: &'a ImuRecording,
) -> Option<Section<'a>> {
    let recording = recording[SensorKind::Accelerometer].as_ref()?;
    let mut section = Section::on_page("Residuals");
    section.figure(|| Some(residuals_over_time(calibration, recovered, recording)));
    section.figure(|| Some(histograms(calibration, recovered, recording)));
    section.figure(|| Some(autocorrelations(calibration, recovered, recording)));
    Some(section)
}
