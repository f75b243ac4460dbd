//! The sections of the page, in their order. Those of the gyroscope are there where it was calibrated.

use super::axes::axis_table;
use super::before_after::improvements;
use super::correction::correction;
use super::fit::fit_table;
use super::holds::{hold_summary, hold_table};
use super::motion::{motion_section, residual_section};
use super::parameters::{column_notes, estimate_table, parameter_table};
use super::quality::nuisances_in_words;
use super::rotations::{rotation_summary, rotation_table, turn_table};
use super::temperature::temperature_in_words;
use super::verdict::verdict;
use crate::About;
use crate::figure::{
    bias_over_temperature, correlation_map_of, drawn, hold_directions, hold_residuals,
    holds_before_and_after, recording_before_and_after, recording_overview, rotation_errors, still_gyroscope,
};
use crate::html::{Page, escape};
use crate::limits::limit_section;
use crate::noise::noise_sections;
use crate::validation::validation_section;
use calibrant_core::estimate::{Calibration, HoldCalibration, Recovered};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// A calibration as one HTML file: verdict, parameters, validations and corrections, the recovered motion or the holds,
/// rotations and turns, noise, fit and correlations.
///
/// The file needs nothing else and fetches nothing. A small script shows values under the pointer and zooms; without it, the page is complete. It suits a wide screen, a phone and A4 paper. Long recordings are
/// thinned for the plots, so that the file stays below about 2 MB whatever their length.
///
/// `recording` is the calibrated recording; `noise` may be empty.
#[must_use]
pub fn calibration_report(
    calibration: &Calibration,
    recording: &ImuRecording,
    noise: &[SensorNoise],
    about: &About,
) -> String {
    let title = if about.title.is_empty() { "Calibration" } else { &about.title };
    let page = Page::of_parts([
        &|| opening(calibration, title, about),
        &|| correction_section(calibration, about),
        &|| recovered(calibration, recording, about),
        &|| rotations(calibration),
        &|| noise_sections(noise),
        &|| fit(calibration, recording),
    ]);
    let footer = match calibration.recovered {
        Recovered::Motion(_) => about.footer(),
        Recovered::Holds(_) => vec![
            about.made(),
            "Directions are true → raw unless stated otherwise. sd is the standard deviation.".to_string(),
        ],
    };
    page.finish(title, &about.facts, &footer)
}

fn opening(calibration: &Calibration, title: &str, about: &About) -> Page {
    let mut page = Page::opened(title, verdict(calibration, about));
    limit_section(&mut page, &about.limits);
    parameters(&mut page, calibration, about);
    validation_section(&mut page, &about.validations);
    page
}

/// The numbers: on the first screen with the verdict, as far as it goes.
fn parameters(page: &mut Page, calibration: &Calibration, about: &About) {
    page.section("Parameters", "");
    let tables: String = match calibration.sensor_kinds() {
        [one] => parameter_table(calibration, *one, about.truth.as_ref()),
        both => {
            let of = |sensor_kind: &SensorKind| {
                format!("<div>{}</div>", estimate_table(calibration, *sensor_kind))
            };
            format!("<div class=\"pair\">{}</div>", both.iter().map(of).collect::<String>())
        }
    };
    page.push(tables);
    if calibration.gyroscope.is_none() {
        page.paragraph(&column_notes(calibration));
    }
    page.paragraph(match calibration.gyroscope {
        None => "Readings are y = S f + b, with f the specific force. Biases are the entries of b, scale factors and matrix entries those of S.",
        Some(_) => "Readings are y = S f + b of the accelerometer and y = S ω + b + Γ f of the gyroscope, with f the specific force and ω the angular rate. Biases are \
             the entries of b, scale factors and matrix entries those of S, g-sensitivities those of Γ.",
    });
    for line in nuisances_in_words(calibration).iter().filter(|_| calibration.holds().is_none()) {
        page.push(format!("<p>{}.</p>", escape(&crate::words::capitalised(line))));
    }
    if let Some(line) = temperature_in_words(calibration) {
        page.push(format!("<p>{}</p>", escape(&line)));
    }
}

/// The correction, and what the parameters mean for it.
fn correction_section(calibration: &Calibration, about: &About) -> Page {
    let mut page = Page::default();
    page.section("Correction, raw → true", "");
    page.push(correction(calibration));
    if calibration.gyroscope.is_some() {
        page.section("Parameters in detail", "");
        for &sensor_kind in calibration.sensor_kinds() {
            page.push(parameter_table(calibration, sensor_kind, about.truth.as_ref()));
        }
        page.paragraph(&column_notes(calibration));
    }
    if let Some(table) = axis_table(calibration) {
        page.subsection("Axes");
        page.push(table);
    }
    page
}

fn recovered(calibration: &Calibration, recording: &ImuRecording, about: &About) -> Page {
    match &calibration.recovered {
        Recovered::Motion(motion) => motion_section(calibration, motion, recording, about),
        Recovered::Holds(holds) => hold_section(calibration, holds, recording),
    }
}

fn hold_section(calibration: &Calibration, holds: &HoldCalibration, recording: &ImuRecording) -> Page {
    let (accelerometer, gyroscope) = (recording.accelerometer.as_ref(), recording.gyroscope.as_ref());
    let [magnitudes, before_and_after, residuals, still, over_temperature, overview] = drawn([
        &|| holds_before_and_after(holds),
        &|| recording_before_and_after(calibration, holds, recording),
        &|| (holds.degrees_of_freedom > 0).then(|| hold_residuals(holds)),
        &|| still_gyroscope(calibration, holds, gyroscope?),
        &|| bias_over_temperature(calibration, holds, gyroscope?),
        &|| Some(recording_overview(holds, accelerometer?)),
    ]);
    let mut page = Page::default();
    page.section(
        "Before and after correction",
        "The readings of the calibration, before and after their correction.",
    );
    page.push(improvements(calibration, holds));
    page.push(magnitudes);
    page.push(before_and_after);
    page.section(
        "Holds",
        match calibration.gyroscope {
            None => "The sensor was at rest in several orientations. In each, the corrected reading has the magnitude of gravity.",
            Some(_) => "The IMU was at rest in several orientations. In each, the corrected accelerometer has the magnitude of gravity, and the corrected gyroscope is zero.",
        },
    );
    page.push(hold_summary(calibration, holds));
    page.push(residuals);
    page.push(still);
    page.push(over_temperature);
    page.push(hold_directions(holds));
    page.push(overview);
    page.subsection("Table of the holds");
    page.push(hold_table(holds, calibration.accelerometer_unit));
    page
}

fn rotations(calibration: &Calibration) -> Page {
    let mut page = Page::default();
    if !calibration.rotations().is_empty() {
        let [figure] = drawn([&|| rotation_errors(calibration.rotations())]);
        page.section("Rotations", "Between the holds the IMU was rotated by hand. The gyroscope propagates gravity from each hold to the next, where the accelerometer measures it.");
        page.push(rotation_summary(calibration));
        page.push(figure);
        page.subsection("Table of the rotations");
        page.push(rotation_table(calibration.rotations()));
    }
    if !calibration.turns().is_empty() {
        page.section(
            "Turns of known angle",
            "Each turn as given, and as the calibrated gyroscope measures it.",
        );
        page.push(turn_table(calibration));
    }
    page
}

fn fit(calibration: &Calibration, recording: &ImuRecording) -> Page {
    let mut page = Page::default();
    if let Recovered::Motion(motion) = &calibration.recovered {
        residual_section(&mut page, calibration, motion, recording);
    }
    page.section(
        "Fit and correlations",
        "Whether the model and the noise describe the data. Only then are the standard deviations right.",
    );
    page.push(fit_table(calibration));
    let names: Vec<&str> = calibration.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    page.push(correlation_map_of(&names, &calibration.covariance));
    page
}
