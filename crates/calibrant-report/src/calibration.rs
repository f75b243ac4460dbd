//! The report page on one calibration of an accelerometer.

use super::figure::{
    acceleration_figure, autocorrelations, correlation_map, force_before_and_after, histograms,
    hold_directions, hold_residuals, holds_before_and_after, motion_error_figure, recording_overview,
    residuals_over_time, state_and_jerk_figure,
};
use super::fit::fit_table;
use super::holds::{hold_summary, hold_table};
use super::html::{Page, escape, facts};
use super::parameters::{correction, parameter_table};
use super::validation::validation_section;
use super::verdict::verdict;
use super::{About, before_after};
use calibrant_core::estimate::{Calibration, HoldCalibration, Recovered, RecoveredMotion};
use calibrant_core::sensor::Recording;

/// A calibration as one HTML file: verdict, parameters, fit, the recovered motion or the holds, residuals, correlations.
///
/// The file needs nothing else: no network, no script. It suits a wide screen, a phone and A4 paper. Long recordings are
/// thinned for the plots, so that the file stays below about 2 MB whatever their length.
///
/// `recording` is the calibrated recording.
#[must_use]
pub fn calibration_report(calibration: &Calibration, recording: &Recording, about: &About) -> String {
    let mut page = Page::default();
    let title = if about.title.is_empty() { "Calibration" } else { &about.title };
    page.push(format!("<h1>{}</h1>", escape(title)));
    page.push(facts(about.facts.iter().map(|(label, value)| (label.as_str(), value.as_str()))));
    page.push(verdict(calibration, about));

    page.section(
        "Parameters",
        "Readings are y = S s + b: biases are the entries of b, scale factors and matrix entries those of S.",
    );
    page.push(parameter_table(calibration, about.truth.as_ref()));
    page.subsection("Correction, raw → true");
    page.push(correction(calibration, recording));

    page.section("Fit", "Whether the model and the assumed noise describe the data, so that the standard deviations can be believed.");
    page.push(fit_table(calibration, recording));

    match &calibration.recovered {
        Recovered::Motion(motion) => {
            motion_section(&mut page, calibration, motion, recording, about);
            page.section("Residuals", "");
            page.push(residuals_over_time(calibration, recording).html());
            page.push(histograms(calibration, recording).html());
            page.push(autocorrelations(calibration, recording).html());
        }
        Recovered::Holds(holds) => hold_section(&mut page, calibration, holds, recording),
    }
    validation_section(&mut page, &about.validations);
    page.section("Correlations", "");
    page.push(correlation_map(&calibration.parameters, &calibration.covariance));
    page.finish(title, &about.footer())
}

fn motion_section(
    page: &mut Page,
    calibration: &Calibration,
    recovered: &RecoveredMotion,
    recording: &Recording,
    about: &About,
) {
    let lead = match recovered.trust {
        "known" => "Trust known: the motion was taken as commanded and not estimated.",
        "noisy" => {
            "Trust noisy: the command was followed up to process noise, and the motion estimated with the parameters."
        }
        "unknown" => {
            "Trust unknown: only the acceleration at both ends was given; the motion in between was estimated with the parameters."
        }
        _ => "",
    };
    page.section("Motion", lead);
    let truth = about.true_motion.as_ref();
    let title = match truth {
        Some(_) => "Actual, measured and estimated acceleration (Figure 4 of the report)",
        None => "Measured and estimated acceleration (Figure 4 of the report)",
    };
    page.push(acceleration_figure(title, calibration, recovered, recording, truth).html());
    if let Some(figure) = motion_error_figure(recovered, recording, truth) {
        page.push(figure.html());
    }
    let title = match truth {
        Some(_) => "Actual and estimated states and inputs (Figure 5 of the report)",
        None => "Estimated states and inputs (Figure 5 of the report)",
    };
    page.push(state_and_jerk_figure(title, recovered, recording, truth).html());
}

fn hold_section(page: &mut Page, calibration: &Calibration, holds: &HoldCalibration, recording: &Recording) {
    page.section(
        "Before and after correction",
        "What the correction makes of the readings that it was found from.",
    );
    page.push(before_after::of_holds(holds));
    let figures =
        [holds_before_and_after(holds), force_before_and_after(holds, &calibration.sensor, recording)];
    for figure in figures {
        page.push(figure.map_or_else(String::new, |figure| figure.html()));
    }
    page.section("Holds", "The sensor was kept still in several orientations; in each, the corrected reading has the magnitude of gravity.");
    page.push(hold_summary(holds));
    if holds.degrees_of_freedom > 0 {
        page.push(hold_residuals(holds).html());
    }
    page.push(hold_directions(holds));
    page.push(recording_overview(holds, recording).html());
    page.subsection("Table of the holds");
    page.push(hold_table(holds, calibration.unit));
}
