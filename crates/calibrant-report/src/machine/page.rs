//! The sections of the page, in their order.

use super::geometry::corrections;
use super::mounting::mounting_in_words;
use super::noise::{reference_noise, sensor_noise};
use super::parameters::{budget, is_widened, mount_table, sensor_table};
use super::quantity::place;
use super::validation::validation_section;
use super::verdict::verdict;
use crate::figure::{
    PLAYER_SCRIPT, Scene, correlation_map_of, drawn, player, residual_coherence, residual_densities,
    residuals_and_speed, sensor_on_tip, three_views,
};
use crate::html::Page;
use crate::limits::limit_section;
use crate::table::Table;
use crate::{About, number_format};
use calibrant_core::sensor::{ImuRecording, SensorKind};
use calibrant_machine::estimate::{
    MachineCalibration, MachineQuantity, MachineSetup, MachineTrust, MachineValidation,
};

/// A calibration on a machine as one HTML file: verdict, parameters and mount, the budget of their variances, the machine in motion, residuals
/// over time and by frequency, noise, geometry and correlations.
///
/// The file needs nothing else. One small script turns and plays the machine; without it, the page is complete but for the motion.
///
/// `recording` is the calibrated recording, `setup` what was known beforehand.
#[must_use]
pub fn machine_report(
    calibration: &MachineCalibration,
    setup: &MachineSetup,
    validations: &[MachineValidation],
    recording: &ImuRecording,
    about: &About,
) -> String {
    let title = if about.title.is_empty() { "Calibration on a machine" } else { &about.title };
    let scene = Scene::of(calibration);
    let page = Page::of_parts([
        &|| opening(calibration, validations, title, about),
        &|| mount(calibration, setup),
        &|| machine(calibration, scene.as_ref()),
        &|| residuals(calibration, recording, scene.as_ref()),
        &|| noise(calibration),
        &|| fit(calibration, setup),
    ]);
    let footer = vec![
        about.made(),
        "Readings are y = S f + b of the accelerometer and y = S ω + b + Γ f of the gyroscope. Motion time = IMU time + delay. sd is the standard deviation.".to_string(),
    ];
    page.finish(title, &about.facts, &footer)
}

fn opening(
    calibration: &MachineCalibration,
    validations: &[MachineValidation],
    title: &str,
    about: &About,
) -> Page {
    let mut page = Page::opened(title, verdict(calibration, validations, about));
    limit_section(&mut page, &about.limits);
    page.section("Parameters of the sensor", "");
    let table = |sensor| format!("<div>{}</div>", sensor_table(calibration, sensor));
    let tables: String = calibration.noise.iter().map(|of| table(of.sensor)).collect();
    page.push(format!("<div class=\"pair\">{tables}</div>"));
    page.paragraph("Biases are the entries of b, matrix entries those of S, g-sensitivities those of Γ.");
    validation_section(&mut page, validations, calibration);
    page
}

fn mount(calibration: &MachineCalibration, setup: &MachineSetup) -> Page {
    let mut page = Page::default();
    page.section("Mount and clock", "Lever arm: from the origin of the tip or the tracked body to the sensor, in its axes. Mounting: turn of the sensor about its own axes against the expected one. Delay: motion time less IMU time. Clock rate: that of the reference against the IMU’s. Tilt: of gravity against the base.");
    page.push(mount_table(calibration, setup));
    if let Some(sentence) = mounting_in_words(calibration, setup) {
        page.paragraph(&sentence);
    }
    if is_widened(calibration) {
        page.paragraph("Sd widened: the factor by which correlation of the residuals in time widens the sd; the stated sd has it.");
    }
    page.section("Budget", "The variance of each parameter of the sensor, by its sources.");
    page.push(budget(calibration));
    page
}

fn machine(calibration: &MachineCalibration, scene: Option<&Scene>) -> Page {
    let mut page = Page::default();
    page.section("The machine", "The motion as the calibration found it, with the corrected geometry.");
    let Some(scene) = scene else {
        page.paragraph("No sample was used.");
        return page;
    };
    let largest = |of: fn(&calibrant_machine::reference::Posture) -> f64| {
        number_format::significant(scene.path.iter().map(of).fold(0.0, f64::max), 3)
    };
    let knots = calibration.motion.knots();
    let mut table = Table::explained();
    table.explain(
        "fastest tip",
        largest(|at| at.speed_mps) + " m/s",
        "Largest speed of the tip, or of the tracked body.",
    );
    table.explain(
        "fastest turn",
        largest(|at| at.rate_radps.to_degrees()) + " °/s",
        "Largest angular rate. A gyroscope’s gains need rotation about each of its axes.",
    );
    table.explain(
        "distance of knots",
        format!("{} ms", number_format::significant(1e3 * knots.step_s, 3)),
        &format!(
            "The motion is a spline of degree {} with {} intervals. It cannot follow anything much faster than two knots.",
            knots.degree.number(),
            number_format::count(knots.intervals)
        ),
    );
    page.push(table.html());
    page.push(player(scene));
    page.push(three_views(scene));
    page.push(sensor_on_tip(&scene.mount, if scene.is_chain { "tip" } else { "body" }));
    page.push(format!("<script>\n{PLAYER_SCRIPT}</script>"));
    page
}

fn residuals(calibration: &MachineCalibration, recording: &ImuRecording, scene: Option<&Scene>) -> Page {
    let mut page = Page::default();
    page.section(
        "Reference against sensor",
        "What the sensor read, less what it should have read on this motion.",
    );
    for noise in &calibration.noise {
        let unit = calibration.units[place(noise.sensor)].map_or("1", |unit| unit.symbol());
        let spectrum =
            recording.sensor(noise.sensor).and_then(|of| calibration.residual_spectrum(noise.sensor, of));
        let [over_time, densities, coherence] = drawn([
            &|| Some(residuals_and_speed(noise, unit, scene?)),
            &|| Some(residual_densities(spectrum.as_ref()?, unit)),
            &|| Some(residual_coherence(spectrum.as_ref()?)),
        ]);
        let stimulus = match noise.sensor {
            SensorKind::Accelerometer => "Accelerometer: specific force",
            SensorKind::Gyroscope => "Gyroscope: angular rate",
        };
        page.subsection(stimulus);
        page.push(over_time + &densities + &coherence);
    }
    page
}

fn noise(calibration: &MachineCalibration) -> Page {
    let mut page = Page::default();
    page.section("Noise", "What the weights of the data are, and where they come from.");
    page.push(sensor_noise(calibration));
    page.push(reference_noise(calibration));
    if calibration.trust == MachineTrust::Known {
        page.paragraph("The reference was trusted as exact: its noise has no weight, and its errors are in the residuals of the sensor.");
    }
    page
}

fn fit(calibration: &MachineCalibration, setup: &MachineSetup) -> Page {
    let mut page = Page::default();
    if let Some(table) = corrections(calibration, setup) {
        page.section("Geometry", "How the machine differs from its file, each correction held near 0 by what was known beforehand. Translations and rotations are in the frame of the joint.");
        page.push(table);
    }
    page.section("Fit and correlations", "Whether model and noise describe the data.");
    let fit = &calibration.fit;
    let mut table = Table::explained();
    table.explain("status", calibration.status.name().into(), "How the iteration ended.");
    table.explain(
        "iterations",
        number_format::count(calibration.iterations),
        "Gauss–Newton steps, once the noise was known.",
    );
    table.explain(
        "last step",
        number_format::significant(calibration.gradient_norm, 2),
        "Length of the last step, in standard deviations of the parameters. Good: far below 1.",
    );
    table.explain("χ²", number_format::significant(fit.chi2, 5), match fit.p_value {
        Some(_) => "Sum of squared residuals over the given noise. Good: near the degrees of freedom.",
        None => "Sum of weighted squared residuals. Noise that was not given comes from these data, so χ² is near the degrees of freedom and tests little.",
    });
    table.explain(
        "degrees of freedom",
        number_format::count(fit.degrees_of_freedom),
        "Number of data less number of unknowns.",
    );
    if let Some(p) = fit.p_value {
        table.explain("p-value", number_format::probability(p), "Probability of a χ² at least this large if model and noise are right. Suspicious: below 0.001 and above 0.999.");
    }
    page.push(table.html());
    let places: Vec<usize> = (calibration.quantities.iter().enumerate())
        .filter(|(_, quantity)| !matches!(quantity, MachineQuantity::Zero(_) | MachineQuantity::Geometry(..)))
        .map(|(place, _)| place)
        .collect();
    let names = calibration.names();
    let names: Vec<&str> = places.iter().map(|place| names[*place].as_str()).collect();
    let covariance = calibration.covariance.select_rows(&places).select_columns(&places);
    page.push(correlation_map_of(&names, &covariance));
    page
}
