//! The output files of a design, and the exit status.

use super::arguments::Arguments;
use super::job::about;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use crate::{budget, console};
use calibrant::DesignPlan;
use calibrant::budget::Budget;
use calibrant::design::{Design, DesignProblem, DesignStatus};
use calibrant::io::{
    DesignFile, DesignSetting, Reached, to_json, write_dense_motion, write_json, write_motion, write_text,
};
use calibrant::report::{About, design_sheet};

/// Writes and shows a design, with the goals that it reaches and a sentence on them.
pub(super) fn finish(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
    design: &Design,
    reached: Option<(&Reached, &str)>,
) -> calibrant::Result<Exit> {
    write(arguments, job, problem, design, reached)?;
    console::result(
        arguments.json,
        || to_json(&file(job, problem, design, reached)),
        &design_sheet(design, &About::default()),
        reached.map(|(_, sentence)| sentence),
        &["motion.csv", "report.html"].map(|name| arguments.output.join(name)),
    )?;
    Ok(exit_of(job, design))
}

fn file<'a>(
    job: &'a DesignPlan,
    problem: &'a DesignProblem<'_>,
    design: &'a Design,
    reached: Option<(&'a Reached, &str)>,
) -> DesignFile<'a> {
    let setting = DesignSetting { problem, settings: &job.settings };
    DesignFile { design, reached: reached.map(|(reached, _)| reached), setting }
}

/// Writes all results of a design.
pub(super) fn write(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
    design: &Design,
    reached: Option<(&Reached, &str)>,
) -> calibrant::Result<()> {
    let (output, axes) = (&arguments.output, problem.sensor.axes);
    // outputs that can fail come first
    if let Some(rate_hz) = arguments.sample_rate {
        write_dense_motion(&output.join("motion_dense.csv"), &design.optimal.motion, axes, rate_hz)?;
    }
    write_json(&output.join("design.json"), &file(job, problem, design, reached))?;
    write_motion(&output.join("motion.csv"), &design.optimal.motion, axes)?;
    let mut about = about(job, arguments, problem, "Design of a motion".into());
    about.findings.extend(reached.map(|(_, sentence)| sentence.to_owned()));
    write_text(&output.join("report.html"), &design_sheet(design, &about).html())
}

/// The exit status of a design, with its warnings.
pub(super) fn exit_of(job: &DesignPlan, design: &Design) -> Exit {
    tell_all(&job.remarks(design));
    let ended = design.status == DesignStatus::Converged || job.is_out_of_time(design);
    if ended && design.optimal.covariance.is_some() { Exit::DONE } else { Exit::NOT_IDENTIFIABLE }
}

/// Checks that the rows of motion_dense.csv fit into the budget.
pub(super) fn check_dense(arguments: &Arguments, problem: &DesignProblem<'_>) -> calibrant::Result<()> {
    let Some(rate_hz) = arguments.sample_rate else { return Ok(()) };
    let rows = problem.intervals as f64 * problem.interval_s * rate_hz;
    let what = format!("{rows:.1e} rows of motion_dense.csv");
    budget::check(Budget::of_samples(rows), &what, "lower --sample-rate")
}
