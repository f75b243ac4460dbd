//! `calibrant design` of a machine: the best trajectory of its joints.

use super::trajectory_output::{about, finish};
use super::{Arguments, trajectory_durations};
use crate::console;
use crate::diagnostics::{tell, tell_all};
use crate::exit::Exit;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::design::MotionNotCompared;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{TrajectoryEvaluationFile, read_earlier_machine, to_json, write_json, write_text};
use calibrant::machine_design::{TrajectoryDesign, TrajectoryEvaluation};
use calibrant::progress::Progress;
use calibrant::report::trajectory_evaluation_sheet;
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
    let earlier = match arguments.from.as_slice() {
        [] => None,
        [path] => Some(read_earlier_machine(path)?),
        _ => {
            return Err(unsuited(
                "a second --from",
                "motions or poses: a machine is as its last calibration found it",
            ));
        }
    };
    let plan = TrajectoryPlan::after(job.experiment, &choice, earlier.as_ref()).map_err(placed)?;
    let plan = plan.with_progress(progress);
    tell_all(&plan.notes());
    if let Some(request) = &arguments.sweep {
        bar.finish_and_clear();
        return trajectory_durations::sweep(arguments, &plan.with_progress(Progress::default()), request);
    }
    if !arguments.reach.is_empty() {
        bar.finish_and_clear();
        return trajectory_durations::reach(arguments, plan.with_progress(Progress::default()));
    }
    if let Some(path) = &arguments.evaluate {
        let evaluation = plan.evaluate(&path.into())?;
        let design = plan.design();
        bar.finish_and_clear();
        let best = design.map_err(|why| tell(MotionNotCompared { why: Phrase(why.to_string()) })).ok();
        return judge(arguments, &plan, (path, &evaluation), best);
    }
    let design = plan.design().map_err(placed);
    bar.finish_and_clear();
    finish(arguments, &plan, design?, None)
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
    let sheet = trajectory_evaluation_sheet(
        evaluation,
        best.map(|best| &best.optimal),
        (&problem, &plan.world),
        &about,
    );
    let page = output.join("evaluation.html");
    write_text(&page, &sheet.html())?;
    console::result(arguments.json, || to_json(&file), &sheet, None, &[page])?;
    let is_kept = evaluation.is_proved() && evaluation.covariance.is_some();
    Ok(if is_kept { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

fn refuse_others_options(arguments: &Arguments) -> calibrant::Result<()> {
    let given = [
        ("--sample-rate", arguments.sample_rate.is_some()),
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
