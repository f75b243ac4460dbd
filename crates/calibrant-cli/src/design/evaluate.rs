//! `calibrant design --evaluate`: compares a user's motion with the best one.

use super::Arguments;
use super::job::{self, about};
use super::output::{exit_of, write};
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::design::{DesignProblem, assess, evaluate};
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::design::MotionNotCompared;
use calibrant::io::{DesignSetting, EvaluationFile, read_motion, to_json, write_json, write_text};
use calibrant::report::evaluation_sheet;
use calibrant::{DesignPlan, undetermined_by};
use std::path::Path;

pub(super) fn run(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
    path: &Path,
) -> calibrant::Result<Exit> {
    let motion = read_motion(path, problem.sensor.axes)?;
    // errors of the motion itself come before the search
    evaluate(problem, &motion)?;
    let optimum = match job::run(job, problem) {
        Ok(design) => {
            write(arguments, job, problem, &design, None)?;
            Ok(design)
        }
        Err(error) if error.is_infeasible() || error.is_not_identifiable() => Err(error.to_string()),
        Err(error) => return Err(error.in_experiment(&arguments.experiment)),
    };
    let assessment = assess(problem, &motion, optimum)?;
    let setting = DesignSetting { problem, settings: &job.settings };
    let file = EvaluationFile { assessment: &assessment, setting };
    write_json(&arguments.output.join("evaluation.json"), &file)?;
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let about = about(job, arguments, problem, format!("Assessment of {name}"));
    let sheet = evaluation_sheet(&assessment, &about);
    let page = arguments.output.join("evaluation.html");
    write_text(&page, &sheet.html())?;
    console::result(arguments.json, || to_json(&file), &sheet, None, &[page])?;
    undetermined_by(&path.display().to_string(), &assessment.evaluation.undetermined).for_each(tell);
    let is_fit = assessment.evaluation.covariance.is_some() && assessment.violations().is_empty();
    let optimum = match &assessment.optimum {
        Ok(design) => exit_of(job, design),
        Err(why) => {
            tell(MotionNotCompared { why: Phrase(why.to_string()) });
            Exit::NOT_IDENTIFIABLE
        }
    };
    Ok(if is_fit { optimum } else { Exit::NOT_IDENTIFIABLE })
}
