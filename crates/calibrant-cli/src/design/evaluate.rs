//! `calibrant design --evaluate`: compares a user's motion with the best one.

use super::Arguments;
use super::job::{self, about};
use super::output::undetermined;
use super::output::{exit_of, write};
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::design::{Assessment, DesignProblem, LimitKind, LimitUse, assess};
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::design::MotionNotCompared;
use calibrant::io::{DesignSetting, EvaluationFile, read_motion, to_json, write_atomically, write_json};
use calibrant::report::evaluation_report;
use calibrant::report::number_format::{counted, short, significant};
use std::path::Path;

pub(super) fn run(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
    path: &Path,
) -> calibrant::Result<Exit> {
    let motion = read_motion(path, problem.sensor.axes)?;
    // errors of the motion itself come before the search
    calibrant::design::evaluate(problem, &motion)?;
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
    let html =
        evaluation_report(&assessment, &about(job, arguments, problem, format!("Assessment of {name}")));
    let page = arguments.output.join("evaluation.html");
    write_atomically(&page, |out| out.write_all(html.as_bytes()))?;
    if arguments.json {
        console::print_always(&to_json(&file));
    } else {
        console::print(&text(&assessment, path));
        console::print(&format!("\n{}\n", page.display()));
    }
    for group in &assessment.evaluation.undetermined {
        tell(undetermined(path.display().to_string(), group));
    }
    let determined = assessment.evaluation.covariance.is_some();
    let optimum = match &assessment.optimum {
        Ok(design) => exit_of(design),
        Err(why) => {
            tell(MotionNotCompared { why: Phrase(why.to_string()) });
            Exit::NOT_IDENTIFIABLE
        }
    };
    Ok(if determined { optimum } else { Exit::NOT_IDENTIFIABLE })
}

fn text(assessment: &Assessment, path: &Path) -> String {
    let own = assessment.evaluation.sd();
    let design = assessment.optimum.as_ref().ok();
    let best = design.map(|design| design.optimal.sd());
    let bound = design.and_then(|design| design.certificate.as_ref()).map(|bound| &bound.sd_lower_bound);
    let rows: Vec<_> = assessment
        .parameters
        .iter()
        .enumerate()
        .map(|(k, parameter)| {
            let other = |sd: Option<f64>| sd.map_or_else(|| "–".into(), |sd| significant(sd, 4));
            let best = best.as_ref().map(|best| best[k]);
            vec![
                parameter.name.clone(),
                parameter.unit.to_owned(),
                significant(own[k], 4),
                other(best),
                best.map_or_else(|| "–".into(), |best| super::table::factor(own[k] / best)),
                other(bound.and_then(|bound| bound.get(k)).copied()),
            ]
        })
        .collect();
    let header = ["parameter", "unit", "sd own", "sd optimal", "own/optimal", "sd at least"];
    let mut text = format!(
        "criterion {} ({}{}): {} own, {} optimal\n",
        assessment.criterion.letter(),
        assessment.criterion.formula(),
        assessment.criterion.scaling(),
        significant(assessment.evaluation.value, 5),
        design.map_or_else(|| "–".into(), |design| significant(design.optimal.value, 5))
    );
    text.push_str(&console::table(&header, &rows));
    if let Some(other) = &assessment.other_setting {
        text.push_str(&console::paragraph(&format!(
            "{} has {} over {} s, but the experiment has {} over {} s. The optimum is that of the experiment, which explains part of the difference.",
            path.display(),
            counted(other.intervals, "interval"),
            short(other.duration_s),
            other.experiment_intervals,
            short(other.experiment_duration_s)
        )));
    }
    if let Some(efficiency) = assessment.efficiency() {
        let certain = assessment.certain_efficiency().map_or_else(String::new, |certain| {
            format!(" (at least {} % of any admissible motion)", significant(100.0 * certain, 3))
        });
        text.push_str(&console::paragraph(&format!(
            "Efficiency {} % of the best motion found{certain}: {}.",
            significant(100.0 * efficiency, 3),
            recordings(efficiency)
        )));
    }
    text.push('\n');
    let broken = assessment.violations();
    if broken.is_empty() {
        text.push_str("  all limits are kept, at all times\n");
    }
    for found in &broken {
        text.push_str(&format!("  {}\n", violation(found)));
    }
    text
}

/// The meaning of an efficiency.
fn recordings(efficiency: f64) -> String {
    if efficiency > 1.0 + 1e-6 {
        "the motion is better than the best motion within the limits".into()
    } else if efficiency > 0.99 {
        "no better motion exists".into()
    } else {
        format!(
            "{} recordings of this motion give as much information as one of the best motion",
            significant(1.0 / efficiency, 3)
        )
    }
}

fn violation(found: &LimitUse) -> String {
    let (axis, unit) = (found.axis, found.kind.unit());
    let number = |value: f64| significant(value, 4);
    match found.kind {
        LimitKind::RestAtEnd => {
            format!("BROKEN: axis {axis} still moves at the end, at {} {unit}", number(found.value))
        }
        LimitKind::StartAcceleration | LimitKind::EndAcceleration => format!(
            "BROKEN: {} of axis {axis} is {} {unit}, prescribed is {}",
            found.kind.name(),
            number(found.value),
            number(found.limit)
        ),
        kind => format!(
            "BROKEN: {} of axis {axis} is {} {unit} at {} s, {} beyond the limit of {} ({} %)",
            kind.name(),
            number(found.value),
            number(found.time_s),
            number(found.excess()),
            number(found.limit),
            significant(100.0 * found.violation, 3)
        ),
    }
}
