//! `calibrant design` of a `[holds]` experiment: the best poses.

use super::pose_output::about;
use super::{Arguments, pose_evaluation};
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::design::poses::{PoseDesign, PoseProblem};
use calibrant::diagnostic::design::SearchInterrupted;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{PoseDesignFile, Reached, to_json, write_json, write_poses, write_text};
use calibrant::report::{pose_in_words, pose_sheet};
use calibrant::{DesignPlan, ReachedDesign};

pub(super) fn run(arguments: &Arguments, job: &DesignPlan) -> calibrant::Result<Exit> {
    refuse_options_of_a_motion(arguments)?;
    if let Some(recording) = &arguments.evaluate {
        return pose_evaluation::run(arguments, job, recording);
    }
    let poses = arguments.add.map(|count| count as usize);
    let problem = job.pose_problem(poses).map_err(|error| error.in_experiment(&arguments.experiment))?;
    design(arguments, job, &problem)
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

fn design(arguments: &Arguments, job: &DesignPlan, problem: &PoseProblem) -> calibrant::Result<Exit> {
    let unit = job.experiment.sensor.unit;
    let (design, reached) = search(arguments, job, problem)?;
    let words: Vec<String> = design.directions.iter().map(pose_in_words).collect();
    let (reached, sentence) = reached.unzip();
    let output = &arguments.output;
    let file = PoseDesignFile { design: &design, reached: reached.as_ref(), problem, unit };
    write_json(&output.join("design.json"), &file)?;
    write_poses(&output.join("poses.csv"), &design.directions, &words)?;
    let mut about = about(arguments, problem, "Poses for a static calibration");
    about.facts.push(("Starts".into(), format!("{}, seed {}", design.starts, job.settings.seed)));
    about.findings.extend(sentence.clone());
    let sheet = pose_sheet(&design, problem, unit, &about);
    write_text(&output.join("report.html"), &sheet.html())?;
    let files = ["poses.csv", "report.html"].map(|name| output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, sentence.as_deref(), &files)?;
    if design.interrupted {
        tell(SearchInterrupted { are_poses: true });
        return Ok(Exit::NOT_IDENTIFIABLE);
    }
    Ok(Exit::DONE)
}

/// The design; the goals that it reaches and a sentence on them, where there are goals.
fn search(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &PoseProblem,
) -> calibrant::Result<(PoseDesign, Option<(Reached, String)>)> {
    if arguments.reach.is_empty() {
        let bar = console::progress(job.settings.starts as u64, "starts");
        let found = job.design_poses(problem, &|done| bar.inc(done));
        bar.finish_and_clear();
        return Ok((found?, None));
    }
    let bar = console::spinner("starts");
    let found = job.reach_by_poses(problem, &arguments.reach, &|done| bar.inc(done));
    bar.finish_and_clear();
    let ReachedDesign { design, reached, sentence } = found?;
    Ok((design, Some((reached, sentence))))
}
