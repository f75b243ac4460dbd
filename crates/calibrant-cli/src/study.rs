//! `calibrant study`: many simulated sensors, truth beside estimate.

use crate::{Exit, console, place};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::CalibrationSettings;
use calibrant::io::{Experiment, Plan, Prior, preset, study_json, write_atomically, write_study};
use calibrant::motion::CommandedMotion;
use calibrant::report::{About, number, study_report};
use calibrant::study::{Study, StudyProblem, StudySettings, run_study};
use std::path::PathBuf;
use std::time::Instant;

/// The experiment without a file: the report's chapter 3.
const DEFAULT: &str = "report-unknown";

/// Simulate and calibrate many sensors, and compare what the calibrations promise with what they deliver.
///
/// Without EXPERIMENT: the report's chapter 3, 50 sensors of which only the acceleration at both ends of the motion is known. Writes study.json and
/// report.html.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (default: the preset report-unknown; see `calibrant init`).
    experiment: Option<PathBuf>,
    /// The commanded motion (default: the random initial motion).
    #[arg(long, value_name = "CSV")]
    motion: Option<PathBuf>,
    /// Number of sensors (default: the one in [study]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    sensors: Option<u32>,
    /// Seed of everything random (default: the one in [study]).
    #[arg(long)]
    seed: Option<u64>,
    /// Print study.json on stdout in place of the tables.
    #[arg(long)]
    json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR", default_value = "calibrant-study")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let started = Instant::now();
    place::check_directory(&arguments.output)?;
    let experiment = match &arguments.experiment {
        Some(path) => Experiment::read(path)?,
        None => Experiment::parse(preset(DEFAULT).unwrap_or_default(), None)?,
    };
    let Plan::Motion(plan) = &experiment.plan else {
        return Err(Error::Experiment(Box::new(Complaint::new(
            "a study needs a [motion] experiment, this one has [holds]",
            "see `calibrant init report-unknown`; a static recording can be made with `calibrant simulate`",
        ))));
    };
    let sensor = &experiment.sensor;
    if sensor.gain.is_none() {
        return Err(Error::Experiment(Box::new(
            Complaint::new("a study needs `gain_counts_per_mps2`", "add it to the experiment file")
                .about_key("sensor.gain_counts_per_mps2"),
        )));
    }
    let seed = arguments.seed.unwrap_or(experiment.study.seed);
    let motion = crate::simulate::commanded_motion(
        arguments.motion.as_deref(),
        plan,
        sensor,
        &experiment.limits,
        seed,
    )?;
    let command = CommandedMotion { motion, trust: plan.trust, known_ends: plan.known_ends };
    let sensors = arguments.sensors.map_or(experiment.study.sensors, |sensors| sensors as usize);
    let problem = StudyProblem { sensor, command: &command, rate_hz: plan.rate_hz, sensors };
    let settings = StudySettings {
        seed,
        calibration: CalibrationSettings {
            datasheet_prior: experiment.calibrate.prior == Prior::Datasheet,
            ..CalibrationSettings::default()
        },
    };
    let bar = console::progress(sensors as u64, "sensors");
    let study = run_study(&problem, &settings, &|done| bar.inc(done))?;
    bar.finish_and_clear();
    let simulated = started.elapsed();
    write_study(&arguments.output.join("study.json"), &study)?;
    let report = arguments.output.join("report.html");
    let about = About {
        title: match &arguments.experiment {
            Some(path) => format!("Study of {}", path.display()),
            None => "Calibration without knowing the motion: the report's chapter 3".into(),
        },
        truth: Some(study.single.truth),
        true_motion: Some(study.single.true_motion.clone()),
        elapsed: Some(format!(
            "{:.3} s, {:.0} sensors per second",
            started.elapsed().as_secs_f64(),
            sensors as f64 / simulated.as_secs_f64()
        )),
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    };
    let html = study_report(&study, &about);
    write_atomically(&report, |out| out.write_all(html.as_bytes()))?;
    if arguments.json {
        console::print(&study_json(&study));
    } else {
        console::print(&summary(&study));
        console::print(&format!("\n{}\n", report.display()));
    }
    Ok(Exit::DONE)
}

fn summary(study: &Study) -> String {
    let rows: Vec<_> = study
        .summary
        .iter()
        .map(|row| {
            vec![
                row.name.clone(),
                row.unit.to_owned(),
                number::significant(row.predicted_sd, 3),
                number::significant(row.realised_rms, 3),
                format!("{:.3}", row.realised_rms / row.predicted_sd),
                format!("{:.1} %", 100.0 * row.coverage_95),
            ]
        })
        .collect();
    let header =
        ["parameter", "unit", "predicted sd", "realised rms error", "ratio", "95 % intervals that hold"];
    let title = format!(
        "{} sensor{}, trust {}, {} intervals, {} Hz, seed {}\n",
        number::count(study.outcomes.len()),
        if study.outcomes.len() == 1 { "" } else { "s" },
        study.trust,
        study.motion.intervals(),
        number::short(study.rate_hz),
        study.seed
    );
    title + &console::table(&header, &rows)
}
