//! `calibrant design` of a `[holds]` experiment: the best poses, or how good recorded holds were.

use super::Arguments;
use super::job::Job;
use super::reach_request::{self, Request};
use super::table::{gap, wrapped};
use crate::{Exit, console};
use calibrant::design::DesignSettings;
use calibrant::design::poses::{
    DirectionKnowledge, PoseDesign, PoseProblem, design_poses, evaluate_poses, fewest_poses, order_for_turns,
};
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{
    pose_design_json, pose_evaluation_json, write_atomically, write_pose_design, write_pose_evaluation,
    write_poses,
};
use calibrant::pipeline::{Pipeline, PipelineOptions, Source};
use calibrant::report::number_format::{counted, significant};
use calibrant::report::{About, evaluation_in_words, pose_evaluation_report, pose_in_words, pose_report};
use calibrant::sensor::{ReadingUnit, SensorParameters};
use nalgebra::{DMatrix, Vector3};
use std::path::Path;

pub(super) fn run(arguments: &Arguments, job: &Job) -> calibrant::Result<Exit> {
    refuse_options_of_a_motion(arguments)?;
    let poses = arguments.add.map(|count| count as usize);
    let problem = job
        .experiment
        .pose_problem(&job.earlier, poses)
        .map_err(|error| super::job::in_file(error, &arguments.experiment))?;
    match &arguments.evaluate {
        Some(recording) => evaluate(arguments, job, problem, recording),
        None => design(arguments, job, &problem),
    }
}

fn refuse_options_of_a_motion(arguments: &Arguments) -> calibrant::Result<()> {
    let given = [
        ("--sweep", arguments.sweep.is_some()),
        ("--sample-rate", arguments.sample_rate.is_some()),
        ("--seconds", arguments.seconds.is_some()),
        ("--no-certificate", arguments.no_certificate),
        ("--gap", arguments.gap.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            format!("{option} is of the design of a motion, and this experiment has [holds]"),
            "leave it away",
        ))),
        None => Ok(()),
    }
}

fn design(arguments: &Arguments, job: &Job, problem: &PoseProblem) -> calibrant::Result<Exit> {
    let unit = job.experiment.sensor.unit;
    let (found, at_least) = search(arguments, job, problem)?;
    let has_gyroscope = job.experiment.imu.is_some();
    let directions = order_for_turns(&found.directions, has_gyroscope);
    let design = PoseDesign { directions, ..found };
    let words: Vec<String> = design.directions.iter().map(pose_in_words).collect();
    let output = &arguments.output;
    write_pose_design(&output.join("design.json"), &design, problem, unit)?;
    write_poses(&output.join("poses.csv"), &design.directions, &words)?;
    let mut about = about(arguments, problem, "Poses for a static calibration");
    about.facts.push(("Starts".into(), format!("{}, seed {}", design.starts, job.settings.seed)));
    about.findings.extend(goal_sentence(arguments, &design, at_least));
    write_page(&output.join("report.html"), &pose_report(&design, problem, unit, has_gyroscope, &about))?;
    if arguments.json {
        console::print(&pose_design_json(&design, problem, unit));
    } else {
        console::print(&text(&design, problem, unit, &words));
        if let Some(sentence) = goal_sentence(arguments, &design, at_least) {
            console::print(&wrapped(&sentence));
        }
        let (poses, report) = (output.join("poses.csv"), output.join("report.html"));
        console::print(&format!("\n{}\n{}\n", poses.display(), report.display()));
    }
    if design.interrupted {
        console::warn(
            "the search was interrupted. The poses are the best so far, and better ones may be near",
        );
        return Ok(Exit::NOT_IDENTIFIABLE);
    }
    Ok(Exit::DONE)
}

/// The design, and the number of poses below which no set reaches the goals, where there are goals.
fn search(
    arguments: &Arguments,
    job: &Job,
    problem: &PoseProblem,
) -> calibrant::Result<(PoseDesign, Option<usize>)> {
    let settings = DesignSettings { starts: job.settings.starts, ..job.settings.clone() };
    if arguments.reach.is_empty() {
        let bar = console::progress(settings.starts as u64, "starts");
        let found = design_poses(problem, &settings, &|done| bar.inc(done));
        bar.finish_and_clear();
        return Ok((found?, None));
    }
    let unit = job.experiment.sensor.unit;
    let gain = problem.at.matrix.diagonal().mean();
    let goals = reach_request::goals(&arguments.reach, &problem.list, unit, gain)?;
    let bar = console::spinner("starts");
    let found = fewest_poses(problem, &goals, &settings, &|done| bar.inc(done));
    bar.finish_and_clear();
    let found = found?;
    Ok((found.design, Some(found.at_least)))
}

/// What came of `--reach`.
fn goal_sentence(arguments: &Arguments, design: &PoseDesign, at_least: Option<usize>) -> Option<String> {
    let wanted: Vec<String> = arguments.reach.iter().map(asked).collect();
    at_least.map(|at_least| {
        let more = if arguments.from.is_empty() { "" } else { "more " };
        format!(
            "{} {more}reach {}. Fewer than {at_least} cannot, whatever their directions.",
            counted(design.directions.len(), "pose"),
            wanted.join(" and ")
        )
    })
}

fn asked(request: &Request) -> String {
    format!("{} to {}", request.name, request.text)
}

fn evaluate(
    arguments: &Arguments,
    job: &Job,
    problem: PoseProblem,
    recording: &Path,
) -> calibrant::Result<Exit> {
    let options = PipelineOptions {
        experiment_file: arguments.experiment.clone(),
        report: false,
        ..PipelineOptions::default()
    };
    let outcome = Pipeline::from_experiment(&job.experiment, options)?.run(&Source::from_file(recording))?;
    outcome.notes.iter().for_each(console::noted);
    let calibration = outcome.calibration();
    let used = calibration.iter().flat_map(|calibration| calibration.hold_results()).filter(|hold| hold.used);
    let directions: Vec<Vector3<f64>> = used.map(|hold| hold.force_mps2.normalize()).collect();
    let at = calibration.map_or(problem.at, |calibration| calibration.imu.accelerometer);
    let problem =
        PoseProblem { at: nominal_where_singular(at, &problem), poses: directions.len(), ..problem };
    let unit = job.experiment.sensor.unit;
    let evaluation = evaluate_poses(&problem, &directions, job.settings.seed)?;
    let output = &arguments.output;
    write_pose_evaluation(&output.join("evaluation.json"), &evaluation, &directions, &problem, unit)?;
    let name = recording.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let about = about(arguments, &problem, &format!("Poses of {name}"));
    let page = output.join("evaluation.html");
    write_page(&page, &pose_evaluation_report(&evaluation, &directions, &problem, unit, &about))?;
    if arguments.json {
        console::print(&pose_evaluation_json(&evaluation, &directions, &problem, unit));
    } else {
        console::print(&parameters(&problem, unit, &evaluation.covariance));
        console::print(&wrapped(&evaluation_in_words(&evaluation, directions.len())));
        console::print(&format!("\n{}\n", page.display()));
    }
    Ok(Exit::DONE)
}

fn nominal_where_singular(at: SensorParameters, problem: &PoseProblem) -> SensorParameters {
    if at.matrix.determinant() > 0.0 { at } else { problem.at }
}

fn write_page(path: &Path, html: &str) -> calibrant::Result<()> {
    write_atomically(path, |out| out.write_all(html.as_bytes()))
}

fn about(arguments: &Arguments, problem: &PoseProblem, title: &str) -> About {
    let directions = match problem.directions {
        DirectionKnowledge::Unknown => "unknown: only |f| = g".into(),
        DirectionKnowledge::Known { sd_rad: 0.0 } => "known exactly".into(),
        DirectionKnowledge::Known { sd_rad } => format!("known to {}°", significant(sd_rad.to_degrees(), 3)),
    };
    let mut facts = vec![
        ("Experiment".to_owned(), arguments.experiment.display().to_string()),
        ("Poses".to_owned(), problem.poses.to_string()),
        ("Directions".to_owned(), directions),
    ];
    facts.extend(arguments.from.iter().map(|path| ("Known before".to_owned(), path.display().to_string())));
    let program = format!("calibrant {}", env!("CARGO_PKG_VERSION"));
    About { title: title.into(), facts, program, ..About::default() }
}

/// Poses, parameters and the efficiency.
fn text(design: &PoseDesign, problem: &PoseProblem, unit: ReadingUnit, words: &[String]) -> String {
    let rows: Vec<_> = design
        .directions
        .iter()
        .zip(words)
        .enumerate()
        .map(|(k, (u, words))| {
            let component = |value: f64| format!("{:.4}", value + 0.0).replace("-0.0000", "0.0000");
            vec![(k + 1).to_string(), words.clone(), component(u.x), component(u.y), component(u.z)]
        })
        .collect();
    let criterion = &problem.criterion;
    let efficiency = 100.0 * design.efficiency(criterion);
    let sentence = format!(
        "At least {} % of the information that any {} can have; {} of {} ended at the best.",
        significant(efficiency, 4),
        counted(design.directions.len(), "allowed pose"),
        design.starts_at_best,
        counted(design.starts, "start")
    );
    format!(
        "criterion {} ({}{}): {}, at least {} (gap {})\n{}\n{}{}",
        criterion.letter(),
        criterion.formula(),
        criterion.scaling(),
        significant(design.value, 5),
        significant(design.bound.value, 5),
        gap(criterion, criterion.gap(design.value, design.bound.value)),
        console::table(&["pose", "how", "up x", "up y", "up z"], &rows),
        parameters(problem, unit, &design.covariance),
        wrapped(&sentence)
    )
}

/// The standard deviations to expect.
fn parameters(problem: &PoseProblem, unit: ReadingUnit, covariance: &DMatrix<f64>) -> String {
    let before = problem.prior.as_ref().and_then(calibrant::information::covariance);
    let rows: Vec<_> = problem
        .list
        .quantities()
        .iter()
        .enumerate()
        .map(|(k, quantity)| {
            let sd = |covariance: &DMatrix<f64>| significant(covariance[(k, k)].sqrt(), 4);
            let mut row = vec![quantity.name(), quantity.unit(unit).to_owned()];
            row.extend(before.as_ref().map(sd));
            row.push(sd(covariance));
            row
        })
        .collect();
    let header: &[&str] = if before.is_some() {
        &["parameter", "unit", "sd before", "sd then"]
    } else {
        &["parameter", "unit", "sd"]
    };
    console::table(header, &rows)
}
