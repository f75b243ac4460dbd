//! The sheet of a calibration on a machine: its sections in their order.

use super::geometry::corrections;
use super::mounting::mounting_in_words;
use super::noise::{reference_noise, sensor_noise};
use super::parameters::{is_widened, mount_table, sensor_table};
use super::validation::validation_section;
use super::verdict::verdict;
use crate::About;
use crate::budget::{self, shares};
use crate::calibration::chi2_rows;
use crate::figure::{
    PLAYER_SCRIPT, Scene, correlation_map, drawn, player, residual_coherence, residual_densities,
    residuals_and_speed, sensor_on_tip, three_views,
};
use crate::limits::limit_section;
use crate::number_format::{count, fixed, significant};
use crate::sheet::{Section, Sheet, Shown, Table};
use calibrant_core::sensor::{ImuRecording, SensorKind};
use calibrant_machine::estimate::{
    MachineCalibration, MachineQuantity, MachineSetup, MachineTrust, MachineValidation, SensorResidual,
};
use std::sync::{Arc, OnceLock};

/// What a reading is, and the delay.
const MODEL: &str = "Readings are y = S f + b of the accelerometer and y = S ω + b + Γ f of the gyroscope. Motion time = IMU time + delay. sd is the standard deviation.";

/// A calibration on a machine as a sheet: verdict, parameters, limits and validations, mount, the budget of the variances, the machine in motion, residuals
/// over time and by frequency, noise, geometry and correlations.
///
/// `recording` is the calibrated recording, `setup` what was known beforehand. On a page, one small script turns and plays the machine; without it, the page is
/// complete but for the motion.
#[must_use]
pub fn machine_sheet<'a>(
    calibration: &'a MachineCalibration,
    setup: &'a MachineSetup,
    validations: &'a [MachineValidation],
    recording: &'a ImuRecording,
    about: &'a About,
) -> Sheet<'a> {
    let scene = SceneOnce::default();
    let mut sections = vec![parameters(calibration)];
    sections.extend(limit_section(&about.limits));
    sections.extend(validation_section(validations, calibration));
    sections.push(mount(calibration, setup, recording));
    sections.push(variances(calibration));
    sections.push(machine(calibration, &scene));
    sections.push(residuals(calibration, recording, &scene));
    sections.push(noise(calibration));
    sections.extend(corrections(calibration, setup));
    sections.push(fit(calibration));
    let verdict = verdict(calibration, validations, about);
    about.sheet("Calibration on a machine", verdict, sections, MODEL)
}

/// The machine in motion. It is followed once, by the first figure that needs it.
#[derive(Clone, Default)]
struct SceneOnce(Arc<OnceLock<Option<Scene>>>);

impl SceneOnce {
    fn of(&self, calibration: &MachineCalibration) -> Option<&Scene> {
        self.0.get_or_init(|| Scene::of(calibration)).as_ref()
    }
}

fn parameters<'a>(calibration: &MachineCalibration) -> Section<'a> {
    let mut section = Section::new("Parameters of the sensor");
    section.tables(calibration.noise.iter().map(|of| sensor_table(calibration, of.sensor)).collect());
    section
        .explanation("Biases are the entries of b, matrix entries those of S, g-sensitivities those of Γ.");
    section
}

fn mount<'a>(
    calibration: &MachineCalibration,
    setup: &MachineSetup,
    recording: &ImuRecording,
) -> Section<'a> {
    let mut section = Section::new("Mount and clock").lead("Lever arm: from the origin of the tip or the tracked body to the sensor, in its axes. Mounting: turn of the sensor about its own axes against the expected one. Delay: motion time less IMU time, in the middle of the recording. Clock rate: that of the reference against the IMU’s. Tilt: of gravity against the base.");
    section.table(mount_table(calibration, setup));
    section.paragraph(delays_at_start(calibration, recording));
    mounting_in_words(calibration, setup).into_iter().for_each(|words| section.paragraph(words));
    if is_widened(calibration) {
        section.explanation("Sd widened: the factor by which correlation of the residuals in time widens the sd; the stated sd has it.");
    }
    section
}

/// The delays at the first sample, where the clocks differ in rate.
fn delays_at_start(calibration: &MachineCalibration, recording: &ImuRecording) -> String {
    let delays: Vec<String> = (calibration.delays_at_start_s(recording).into_iter())
        .map(|(sensor, delay_s)| format!("{} ms ({sensor})", fixed(1e3 * delay_s, 3)))
        .collect();
    format!(
        "The delays are those in the middle of the recording. At its start they are {}.",
        delays.join(" and ")
    )
}

fn variances(calibration: &MachineCalibration) -> Section<'_> {
    let mut section =
        Section::new("Budget").lead("The variance of each parameter of the sensor, by its sources.");
    section.table(shares(&calibration.sensors.budget).shown(Shown::OnTerminal));
    budget::on_page(&mut section, &calibration.sensors);
    section
}

fn machine<'a>(calibration: &'a MachineCalibration, scene: &SceneOnce) -> Section<'a> {
    let mut section = Section::on_page("The machine")
        .lead("The motion as the calibration found it, with the corrected geometry.");
    let scene = scene.clone();
    section
        .drawn(move || scene.of(calibration).map_or_else(|| "<p>No sample was used.</p>".into(), in_motion));
    section
}

/// How fast the machine moved, the player, and what it looks like.
fn in_motion(scene: &Scene) -> String {
    let largest = |of: fn(&calibrant_machine::reference::Posture) -> f64| {
        significant(scene.path.iter().map(of).fold(0.0, f64::max), 3)
    };
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
    let mount = sensor_on_tip(&scene.mount, if scene.is_chain { "tip" } else { "body" });
    let script = format!("<script>\n{PLAYER_SCRIPT}</script>");
    [table.html(), player(scene), three_views(scene), mount, script].join("\n")
}

fn residuals<'a>(
    calibration: &'a MachineCalibration,
    recording: &'a ImuRecording,
    scene: &SceneOnce,
) -> Section<'a> {
    let mut section = Section::on_page("Reference against sensor")
        .lead("What the sensor read, less what it should have read on this motion.");
    for noise in &calibration.noise {
        section.subheading(match noise.sensor {
            SensorKind::Accelerometer => "Accelerometer: specific force",
            SensorKind::Gyroscope => "Gyroscope: angular rate",
        });
        let scene = scene.clone();
        section.drawn(move || of_sensor(calibration, noise, recording, scene.of(calibration)));
    }
    section
}

/// The residuals of a sensor over time and by frequency.
fn of_sensor(
    calibration: &MachineCalibration,
    noise: &SensorResidual,
    recording: &ImuRecording,
    scene: Option<&Scene>,
) -> String {
    let unit = calibration.sensors.unit(noise.sensor).symbol();
    let spectrum =
        recording.sensor(noise.sensor).and_then(|of| calibration.residual_spectrum(noise.sensor, of));
    drawn([
        &|| Some(residuals_and_speed(noise, unit, scene?)),
        &|| Some(residual_densities(spectrum.as_ref()?, unit)),
        &|| Some(residual_coherence(spectrum.as_ref()?)),
    ])
    .concat()
}

fn noise<'a>(calibration: &MachineCalibration) -> Section<'a> {
    let mut section =
        Section::new("Noise").lead("What the weights of the data are, and where they come from.");
    section.table(sensor_noise(calibration));
    section.table(reference_noise(calibration));
    if calibration.trust == MachineTrust::Known {
        section.explanation("The reference was trusted as exact: its noise has no weight, and its errors are in the residuals of the sensor.");
    }
    section
}

fn fit(calibration: &MachineCalibration) -> Section<'_> {
    let mut section = Section::new("Fit and correlations").lead("Whether model and noise describe the data.");
    section.table(fit_table(calibration));
    section.drawn(|| {
        let of_joint = |quantity: &MachineQuantity| {
            matches!(quantity, MachineQuantity::Zero(_) | MachineQuantity::Geometry(..))
        };
        let places: Vec<usize> =
            (0..calibration.quantities.len()).filter(|k| !of_joint(&calibration.quantities[*k])).collect();
        let names = calibration.names();
        let covariance = calibration.covariance.select_rows(&places).select_columns(&places);
        correlation_map(places.iter().map(|place| names[*place].as_str()), &covariance)
    });
    section
}

fn fit_table(calibration: &MachineCalibration) -> Table {
    let mut table = Table::explained();
    table.explain("status", calibration.sensors.status.name().into(), "How the iteration ended.");
    table.explain(
        "iterations",
        count(calibration.sensors.iterations),
        "Gauss–Newton steps, once the noise was known.",
    );
    table.explain_on_page(
        "last step",
        significant(calibration.sensors.gradient_norm, 2),
        "Length of the last step, in standard deviations of the parameters. Good: far below 1.",
    );
    let from_data = "Sum of weighted squared residuals. Noise that was not given comes from these data, so χ² is near the degrees of freedom and tests little.";
    chi2_rows(
        &mut table,
        &calibration.sensors.fit,
        [", noise from the residuals", from_data],
        Shown::Everywhere,
    );
    let knots = calibration.motion.knots();
    table.explain(
        "knots of the motion",
        format!("every {} ms, degree {}", significant(1e3 * knots.step_s, 3), knots.degree.number()),
        &format!(
            "The motion is a spline with {} intervals. It cannot follow anything much faster than two knots.",
            count(knots.intervals)
        ),
    );
    table
}
