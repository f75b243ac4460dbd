//! `calibrant design` of a machine: the best trajectory of its joints.

use super::Arguments;
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::design::DesignStatus;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{TrajectoryEvaluationFile, TrajectoryFile, to_json, write_json, write_text};
use calibrant::machine_design::{TrajectoryDesign, TrajectoryEvaluation};
use calibrant::progress::Progress;
use calibrant::report::number_format::short;
use calibrant::report::{About, trajectory_evaluation_sheet, trajectory_sheet};
use calibrant::{DesignChoice, DesignPlan, TrajectoryPlan};
use std::path::Path;

/// Refuses what only the trajectory of a machine takes.
pub(super) fn refuse_its_options(arguments: &Arguments) -> calibrant::Result<()> {
    match arguments.slow {
        Some(_) => Err(unsuited("--slow", "the trajectory of a machine, and this experiment has none")),
        None => Ok(()),
    }
}

pub(super) fn run(arguments: &Arguments, job: DesignPlan) -> calibrant::Result<Exit> {
    refuse_others_options(arguments)?;
    // the experiment has the criterion that was chosen
    let choice = DesignChoice {
        starts: Some(job.settings.starts),
        seconds: job.settings.seconds,
        seed: Some(job.settings.seed),
        interruption: job.settings.interruption,
        ..DesignChoice::default()
    };
    let placed = |error: Error| error.in_experiment(&arguments.experiment);
    let bar = console::progress(1, "search");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let shown = bar.clone();
    let progress = Progress::to(move |step| {
        shown.set_length(step.of);
        shown.set_position(step.done);
        shown.set_message(step.what);
    });
    let plan = TrajectoryPlan::new(job.experiment, &choice).map_err(placed)?.with_progress(progress);
    tell_all(&plan.notes());
    if let Some(path) = &arguments.evaluate {
        let evaluation = plan.evaluate(path)?;
        let design = plan.design();
        bar.finish_and_clear();
        return judge(arguments, &plan, (path, &evaluation), design.ok());
    }
    let design = plan.design().map_err(placed);
    bar.finish_and_clear();
    finish(arguments, &plan, design?)
}

fn finish(
    arguments: &Arguments,
    plan: &TrajectoryPlan,
    mut design: TrajectoryDesign,
) -> calibrant::Result<Exit> {
    let mut title = "Trajectory of a machine".to_owned();
    if let Some(times) = arguments.slow {
        design.optimal = plan.slowed(&design.optimal, times)?;
        title += &format!(", {} times slower", short(times));
    }
    let output = &arguments.output;
    let mut files = plan.write(&design, output)?;
    let problem = plan.problem();
    let about = about(arguments, plan, title);
    let sheet = trajectory_sheet(&design, &problem, &about);
    let page = output.join("report.html");
    write_text(&page, &sheet.html())?;
    files.push(page);
    let file = TrajectoryFile { design: &design, problem: &problem, plan: &plan.machine, world: &plan.world };
    console::result(arguments.json, || to_json(&file), &sheet, None, &files);
    tell_all(&plan.remarks(&design));
    let done = matches!(design.status, DesignStatus::Converged | DesignStatus::IterationLimit);
    Ok(if done && design.optimal.covariance.is_some() { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

fn judge(
    arguments: &Arguments,
    plan: &TrajectoryPlan,
    (path, evaluation): (&Path, &TrajectoryEvaluation),
    design: Option<TrajectoryDesign>,
) -> calibrant::Result<Exit> {
    let problem = plan.problem();
    let best = design.as_ref();
    let output = &arguments.output;
    let file = TrajectoryEvaluationFile {
        evaluation,
        design: best,
        problem: &problem,
        plan: &plan.machine,
        world: &plan.world,
    };
    write_json(&output.join("evaluation.json"), &file)?;
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let about = about(arguments, plan, format!("Assessment of {name}"));
    let sheet = trajectory_evaluation_sheet(evaluation, best.map(|best| &best.optimal), &problem, &about);
    let page = output.join("evaluation.html");
    write_text(&page, &sheet.html())?;
    console::result(arguments.json, || to_json(&file), &sheet, None, &[page]);
    let is_kept = evaluation.is_proved() && evaluation.covariance.is_some();
    Ok(if is_kept { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

fn about(arguments: &Arguments, plan: &TrajectoryPlan, title: String) -> About {
    let fact = |label: &str, text: String| (label.to_owned(), text);
    let facts = vec![
        fact("Experiment", arguments.experiment.display().to_string()),
        fact(
            "Machine",
            format!(
                "{} joints, from {} to {}",
                plan.machine.chain.joints.len(),
                plan.machine.chain.base,
                plan.machine.chain.tip
            ),
        ),
        fact(
            "Duration",
            format!("{} s, waypoints every {} s", short(plan.machine.duration_s), short(plan.machine.knot_s)),
        ),
        fact("Starts", format!("{}, seed {}", plan.settings.starts, plan.settings.seed)),
    ];
    About { title, facts, ..About::default() }
}

fn refuse_others_options(arguments: &Arguments) -> calibrant::Result<()> {
    let given = [
        ("--sweep", arguments.sweep.is_some()),
        ("--sample-rate", arguments.sample_rate.is_some()),
        ("--reach", !arguments.reach.is_empty()),
        ("--from", !arguments.from.is_empty()),
        ("--add", arguments.add.is_some()),
        ("--no-certificate", arguments.no_certificate),
        ("--gap", arguments.gap.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(unsuited(option, "motions or poses, and this experiment has [machine]")),
        None => Ok(()),
    }
}

fn unsuited(option: &str, of: &str) -> Error {
    let message = format!("{option} is of the design of {of}");
    Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, "leave it away"))
}
