//! Designs of a commanded motion: the best one, one beside it, the best as one quantity changes.

use crate::choice::{Choice, chosen, counter, teller};
use crate::experiment::Experiment;
use crate::failure::invalid;
use crate::motion::{Motion, Nodes, nodes};
use crate::page::{Page, page};
use crate::series::series;
use crate::work::Run;
use calibrant::design::{Design, DesignProblem, DesignStatus, SweepVariable, assess as assessed, evaluate};
use calibrant::io::{DesignFile, DesignSetting, EvaluationFile, SweepFile, read_motion, to_json};
use calibrant::report::{About, design_sheet, evaluation_sheet, sweep_sheet};
use calibrant::session::MotionSource;
use calibrant::{DesignPlan, ReachedDesign, Result, rest_remark, sweep_remarks, undetermined_by};
use pyo3::prelude::*;

/// Value, bound, gap of the best motion, and whether the search was interrupted.
type Value = (f64, Option<f64>, Option<f64>, bool);
/// The result, and of the best motion its nodes and its value.
type Found<'py> = (Page, Option<(Nodes<'py>, Value)>);

fn found<'py>(py: Python<'py>, page: Page, design: Option<&Design>) -> Found<'py> {
    let value = |of: &Design| {
        let (bound, gap) = of.certificate.as_ref().map(|bound| (bound.lower_bound, bound.gap)).unzip();
        (of.optimal.value, bound, gap, of.status == DesignStatus::Interrupted)
    };
    (page, design.map(|of| (nodes(py, &of.optimal.motion), value(of))))
}

fn starts(plan: &DesignPlan, problem: &DesignProblem<'_>) -> u64 {
    (plan.settings.starts * problem.sensor.axes) as u64
}

/// Finds the best motion, or the shortest that reaches goals.
#[pyfunction]
#[pyo3(signature = (experiment, choice, *, threads=None, progress=None))]
pub(crate) fn design<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found<'py>> {
    let (page, best) = chosen(py, experiment, choice, (threads, progress), |experiment, choice, given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(experiment, given)?;
        let problem = plan.problem().map_err(&placed)?;
        let mut notes = plan.notes.clone();
        notes.extend(rest_remark(problem.limits));
        let goals = choice.reach()?;
        let told = counter(given, "starts", starts(&plan, &problem));
        let (problem, found, reached) = if goals.is_empty() {
            let found = plan.design(&problem, &told).map_err(&placed)?;
            (problem, found, None)
        } else {
            let (problem, found) = plan.reach(&problem, &goals, &told).map_err(&placed)?;
            let ReachedDesign { design, reached, sentence } = found;
            (problem, design, Some((reached, sentence)))
        };
        notes.extend(plan.remarks(&found));
        let setting = DesignSetting { problem: &problem, settings: &plan.settings };
        let (reached, sentence) = reached.unzip();
        let json = to_json(&DesignFile { design: &found, reached: reached.as_ref(), setting });
        let findings = sentence.into_iter().collect();
        let about = About { title: "Design of a motion".into(), findings, ..About::default() };
        let page = page(json, &notes, &design_sheet(&found, &about));
        Ok((page, found))
    })?;
    Ok(self::found(py, page, Some(&best)))
}

/// Puts a motion beside the best one.
#[pyfunction]
#[pyo3(signature = (experiment, motion, choice, *, threads=None, progress=None))]
pub(crate) fn assess<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    motion: &Motion,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found<'py>> {
    let (source, how) = (motion.0.clone(), (threads, progress));
    let (page, best) = chosen(py, experiment, choice, how, move |experiment, choice, given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(experiment, given)?;
        let problem = plan.problem().map_err(&placed)?;
        let motion = match &source {
            MotionSource::File(path) => read_motion(path, problem.sensor.axes)?,
            MotionSource::Commanded(motion) => motion.clone(),
            MotionSource::Logged(_) | MotionSource::OnKnots(..) => {
                return Err(invalid("a log of a machine is no commanded motion", "give the nodes of one"));
            }
        };
        // errors of the motion itself come before the search
        evaluate(&problem, &motion)?;
        let optimum = match plan.design(&problem, &counter(given, "starts", starts(&plan, &problem))) {
            Ok(design) => Ok(design),
            Err(error) if error.is_infeasible() || error.is_not_identifiable() => Err(error.to_string()),
            Err(error) => return Err(placed(error)),
        };
        let found = assessed(&problem, &motion, optimum)?;
        let mut notes = plan.notes.clone();
        notes.extend(undetermined_by("the motion", &found.evaluation.undetermined));
        let setting = DesignSetting { problem: &problem, settings: &plan.settings };
        let json = to_json(&EvaluationFile { assessment: &found, setting });
        let about = About { title: "Assessment of a motion".into(), ..About::default() };
        let page = page(json, &notes, &evaluation_sheet(&found, &about));
        Ok((page, found.optimum.ok()))
    })?;
    Ok(found(py, page, best.as_ref()))
}

/// The best motions as one quantity changes.
pub(crate) fn sweep(
    experiment: &Experiment,
    (variable, values): (SweepVariable, &[f64]),
    choice: &Choice,
    given: &Run,
) -> Result<Page> {
    let placed = Experiment::placed(&experiment.file);
    let plan = choice.plan(experiment, given)?;
    let problem = plan.problem().map_err(&placed)?;
    let told = teller(given, "values", values.len());
    let swept = plan.sweep(&problem, variable, values, &told).map_err(&placed)?;
    let mut notes = plan.notes.clone();
    notes.extend(rest_remark(problem.limits));
    notes.extend(series(given, swept.points.len(), values.len())?);
    notes.extend(sweep_remarks(&swept));
    let setting = DesignSetting { problem: &problem, settings: &plan.settings };
    let json = to_json(&SweepFile { sweep: &swept, setting });
    let title = format!("Best motions over the {}", variable.name());
    let about = About { title, ..About::default() };
    Ok(page(json, &notes, &sweep_sheet(&swept, &about)))
}
