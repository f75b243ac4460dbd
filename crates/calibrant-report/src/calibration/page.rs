//! The sheet of a calibration: its sections in their order. Those of the gyroscope are there where it was calibrated.

use super::axes::axes;
use super::before_after::improvements;
use super::correction::correction;
use super::fit::fit_table;
use super::holds::{hold_summary, hold_table};
use super::motion::{motion_section, residual_section};
use super::parameters::{estimate_table, parameter_table};
use super::quality::{nuisances_in_words, temperature_in_words};
use super::rotations::{rotation_summary, rotation_table, turn_table};
use super::verdict::verdict;
use crate::budget;
use crate::figure::{
    bias_over_temperature, correlation_map, hold_directions, hold_residuals, holds_before_and_after,
    recording_before_and_after, recording_overview, rotation_errors, still_gyroscope,
};
use crate::limits::limit_section;
use crate::noise::noise_sections;
use crate::number_format::capitalised;
use crate::report_context::{About, READINGS};
use crate::sheet::{Section, Sheet, Shown};
use crate::validation::validation_section;
use calibrant_core::estimate::{Calibration, HoldCalibration, Recovered};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// A calibration as a sheet: verdict, parameters, limits and validations, corrections, the recovered motion or the holds, rotations and turns, noise,
/// fit and correlations.
///
/// Long recordings are thinned for the figures, so that a page stays below about 2 MB whatever their length.
///
/// `recording` is the calibrated recording; `noise` may be empty.
#[must_use]
pub fn calibration_sheet<'a>(
    calibration: &'a Calibration,
    recording: &'a ImuRecording,
    noise: &'a [SensorNoise],
    about: &'a About,
) -> Sheet<'a> {
    let mut sections = vec![parameters(calibration, about)];
    sections.extend(limit_section(&about.limits));
    sections.extend(validation_section(&about.validations));
    sections.push(correction_section(calibration));
    if calibration.gyroscope.is_some() {
        sections.push(details(calibration, about));
    }
    match &calibration.recovered {
        Recovered::Motion(motion) => sections.push(motion_section(calibration, motion, recording, about)),
        Recovered::Holds(holds) => {
            sections.push(before_and_after(calibration, holds, recording));
            sections.push(hold_section(calibration, holds, recording));
        }
        // its own sheet has the motion
        Recovered::OnMachine(_) => {}
    }
    sections.extend(rotations(calibration));
    sections.extend(variances(calibration));
    sections.extend(noise_sections(noise).into_iter().map(Section::for_page));
    if let Recovered::Motion(motion) = &calibration.recovered {
        sections.extend(residual_section(calibration, motion, recording));
    }
    sections.push(fit(calibration));
    let meaning = match calibration.recovered {
        Recovered::Motion(_) => READINGS,
        Recovered::Holds(_) | Recovered::OnMachine(_) => {
            "Directions are true → raw unless stated otherwise. sd is the standard deviation."
        }
    };
    about.sheet("Calibration", verdict(calibration, about), sections, meaning)
}

/// The numbers: on the first screen with the verdict, as far as it goes. Those of two sensors stand beside each other on a page, which has their
/// details in a section of its own.
fn parameters<'a>(calibration: &Calibration, about: &About) -> Section<'a> {
    let mut section = Section::new("Parameters");
    let kinds = calibration.sensor_kinds();
    let full = |&of| parameter_table(calibration, of, about.truth.as_ref());
    match kinds.as_slice() {
        [one] => section.table(full(one)),
        both => {
            section.tables(both.iter().map(|&of| estimate_table(calibration, of).on_page()).collect());
            both.iter().for_each(|of| section.table(full(of).shown(Shown::OnTerminal)));
        }
    }
    section.explanation(match calibration.gyroscope {
        None => "Readings are y = S f + b, with f the specific force. Biases are the entries of b, scale factors and matrix entries those of S.",
        Some(_) => "Readings are y = S f + b of the accelerometer and y = S ω + b + Γ f of the gyroscope, with f the specific force and ω the angular rate. Biases are \
             the entries of b, scale factors and matrix entries those of S, g-sensitivities those of Γ.",
    });
    nuisances_in_words(calibration).iter().for_each(|words| section.paragraph(capitalised(words) + "."));
    temperature_in_words(calibration).into_iter().for_each(|words| section.paragraph(words));
    section
}

fn correction_section<'a>(calibration: &'a Calibration) -> Section<'a> {
    let mut section = Section::on_page("Correction, raw → true");
    section.drawn(|| correction(calibration));
    if calibration.gyroscope.is_none() {
        axes(&mut section, calibration);
    }
    section
}

/// The parameters of both sensors, and what they mean for the axes.
fn details<'a>(calibration: &Calibration, about: &About) -> Section<'a> {
    let mut section = Section::on_page("Parameters in detail");
    for sensor_kind in calibration.sensor_kinds() {
        section.table(parameter_table(calibration, sensor_kind, about.truth.as_ref()));
    }
    axes(&mut section, calibration);
    section
}

fn before_and_after<'a>(
    calibration: &'a Calibration,
    holds: &'a HoldCalibration,
    recording: &'a ImuRecording,
) -> Section<'a> {
    let mut section = Section::on_page("Before and after correction")
        .lead("The readings of the calibration, before and after their correction.");
    section.table(improvements(calibration, holds));
    section.figure(|| holds_before_and_after(holds));
    section.figure(|| recording_before_and_after(calibration, holds, recording));
    section
}

fn hold_section<'a>(
    calibration: &'a Calibration,
    holds: &'a HoldCalibration,
    recording: &'a ImuRecording,
) -> Section<'a> {
    let mut section = Section::new("Holds").lead(match calibration.gyroscope {
        None => "The sensor was at rest in several orientations. In each, the corrected reading has the magnitude of gravity.",
        Some(_) => "The IMU was at rest in several orientations. In each, the corrected accelerometer has the magnitude of gravity, and the corrected gyroscope is zero.",
    });
    section.table(hold_summary(calibration, holds));
    section.figure(|| (holds.degrees_of_freedom > 0).then(|| hold_residuals(holds)));
    section.figure(|| still_gyroscope(calibration, holds, recording[SensorKind::Gyroscope].as_ref()?));
    section.figure(|| bias_over_temperature(calibration, holds, recording[SensorKind::Gyroscope].as_ref()?));
    section.figure(|| Some(hold_directions(holds)));
    section.figure(|| Some(recording_overview(holds, recording[SensorKind::Accelerometer].as_ref()?)));
    section
        .on_page_below("Table of the holds", hold_table(holds, calibration.unit(SensorKind::Accelerometer)));
    section
}

fn rotations(calibration: &Calibration) -> Vec<Section<'_>> {
    let mut sections = Vec::new();
    if !calibration.rotations().is_empty() {
        let mut section = Section::new("Rotations").lead("Between the holds the IMU was rotated by hand. The gyroscope propagates gravity from each hold to the next, where the accelerometer measures it.");
        section.table(rotation_summary(calibration));
        section.figure(|| rotation_errors(calibration.rotations()));
        section.on_page_below("Table of the rotations", rotation_table(calibration.rotations()));
        sections.push(section);
    }
    if !calibration.turns().is_empty() {
        let mut section = Section::on_page("Turns of known angle")
            .lead("Each turn as given, and as the calibrated gyroscope measures it.");
        section.table(turn_table(calibration));
        sections.push(section);
    }
    sections
}

/// Where there is more than the noise.
fn variances(calibration: &Calibration) -> Option<Section<'_>> {
    (calibration.variance_sources().len() > 1).then(|| {
        let mut section = Section::on_page("Budget").lead("The variance of each parameter, by its sources.");
        budget::on_page(&mut section, calibration);
        section
    })
}

fn fit(calibration: &Calibration) -> Section<'_> {
    let mut section = Section::new("Fit and correlations").lead(
        "Whether the model and the noise describe the data. Only then are the standard deviations right.",
    );
    section.table(fit_table(calibration));
    section.drawn(|| {
        let names = calibration.parameters.iter().map(|parameter| parameter.name.as_str());
        correlation_map(names, &calibration.covariance)
    });
    section
}
