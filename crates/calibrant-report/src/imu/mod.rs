//! The report page on a whole IMU: accelerometer and gyroscope, and how they fit each other.

mod axes;
mod correction;
mod fit;
mod parameters;
mod quality;
mod rotations;
mod temperature;
mod verdict;

pub use parameters::over_the_gain;
pub use quality::imu_quality;
pub use temperature::temperature_in_words;

use super::figure::{
    bias_over_temperature, correlation_map_of, drawn, hold_directions, hold_residuals,
    holds_before_and_after, imu_before_and_after, recording_overview, rotation_errors, still_gyroscope,
};
use super::holds::{hold_summary, hold_table};
use super::html::{Page, escape, facts};
use super::noise::noise_sections;
use super::validation::validation_section;
use super::{About, before_after};
use calibrant_core::estimate::{ImuCalibration, Validation};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// A whole IMU as one HTML file. It has the verdict, parameters and corrections of both sensors, holds,
/// rotations, turns and correlations. It has the noise where that was determined.
///
/// Self-contained as [`calibration_report`](super::calibration_report) is. `recording` is the calibrated
/// recording; `noise` may be empty.
#[must_use]
pub fn imu_calibration_report(
    calibration: &ImuCalibration,
    recording: &ImuRecording,
    noise: &[SensorNoise],
    about: &About,
) -> String {
    let title = if about.title.is_empty() { "Calibration of an IMU" } else { &about.title };
    let page = Page::of_parts([
        &|| opening(calibration, title, about),
        &|| parameters(calibration),
        &|| correction(calibration, recording),
        &|| holds(calibration, recording),
        &|| rotations(calibration),
        &|| noise_sections(noise),
        &|| fit(calibration, &about.validations),
    ]);
    page.finish(
        title,
        &[
            about.made(),
            "Directions are true → raw where nothing else is said; sd is the standard deviation.".to_string(),
        ],
    )
}

fn opening(calibration: &ImuCalibration, title: &str, about: &About) -> Page {
    let mut page = Page::default();
    page.push(format!("<h1>{}</h1>", escape(title)));
    page.push(facts(about.facts.iter().map(|(label, value)| (label.as_str(), value.as_str()))));
    page.push(verdict::verdict(calibration, about));
    page
}

fn parameters(calibration: &ImuCalibration) -> Page {
    let mut page = Page::default();
    page.section(
        "Parameters",
        "Readings are y = S f + b of the accelerometer and y = S ω + b + Γ f of the gyroscope, with f the specific force and ω the angular rate: biases are \
         the entries of b, scale factors and matrix entries those of S, g-sensitivities those of Γ. In files, their names begin with that of the sensor: gyroscope.bias.x.",
    );
    for sensor_kind in SensorKind::ALL {
        page.subsection(capitalised(sensor_kind));
        page.push(parameters::parameter_table(calibration, sensor_kind));
    }
    if let Some(line) = temperature_in_words(calibration) {
        page.push(format!("<p>{}</p>", escape(&line)));
    }
    page.subsection("Axes");
    page.push(axes::axis_table(calibration));
    page
}

fn correction(calibration: &ImuCalibration, recording: &ImuRecording) -> Page {
    let [of_holds, of_recording] = drawn([&|| holds_before_and_after(&calibration.holds), &|| {
        imu_before_and_after(calibration, recording)
    }]);
    let mut page = Page::default();
    page.section("Correction, raw → true", "");
    page.push(correction::correction(calibration));

    page.section(
        "Before and after correction",
        "What the correction makes of the readings that it was found from.",
    );
    page.push(before_after::of_imu(calibration));
    page.push(of_holds);
    page.push(of_recording);
    page
}

fn holds(calibration: &ImuCalibration, recording: &ImuRecording) -> Page {
    let holds = &calibration.holds;
    let (accelerometer, gyroscope) = (recording.accelerometer.as_ref(), recording.gyroscope.as_ref());
    let [residuals, still, over_temperature, overview] = drawn([
        &|| (holds.degrees_of_freedom > 0).then(|| hold_residuals(holds)),
        &|| still_gyroscope(calibration, gyroscope?),
        &|| bias_over_temperature(calibration, gyroscope?),
        &|| Some(recording_overview(holds, accelerometer?)),
    ]);
    let mut page = Page::default();
    page.section("Holds", "The IMU was kept still in several orientations; in each, the corrected accelerometer has the magnitude of gravity and the corrected gyroscope is zero.");
    page.push(hold_summary(holds));
    page.push(residuals);
    page.push(still);
    page.push(over_temperature);
    page.push(hold_directions(holds));
    page.push(overview);
    page.subsection("Table of the holds");
    page.push(hold_table(holds, calibration.accelerometer_unit));
    page
}

fn rotations(calibration: &ImuCalibration) -> Page {
    let mut page = Page::default();
    if !calibration.rotations.is_empty() {
        let [figure] = drawn([&|| rotation_errors(&calibration.rotations)]);
        page.section("Rotations", "Between the holds the IMU was turned by hand. The gyroscope must carry gravity from each hold to the next.");
        page.push(rotations::rotation_summary(calibration));
        page.push(figure);
        page.subsection("Table of the rotations");
        page.push(rotations::rotation_table(&calibration.rotations));
    }
    if !calibration.turns.is_empty() {
        page.section(
            "Turns of known angle",
            "What the calibrated gyroscope shows of each turn, beside what was made.",
        );
        page.push(rotations::turn_table(calibration));
    }
    page
}

fn fit(calibration: &ImuCalibration, validations: &[Validation]) -> Page {
    let mut page = Page::default();
    validation_section(&mut page, validations);
    page.section("Fit and correlations", "");
    page.push(fit::fit_table(calibration));
    let names: Vec<String> = calibration.quantities.iter().map(|quantity| quantity.name()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    page.push(correlation_map_of(&names, &calibration.covariance));
    page
}

fn capitalised(sensor_kind: SensorKind) -> &'static str {
    match sensor_kind {
        SensorKind::Accelerometer => "Accelerometer",
        SensorKind::Gyroscope => "Gyroscope",
    }
}
