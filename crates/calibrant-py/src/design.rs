//! Designs: of a commanded motion, of poses, of a machine's trajectory.

use crate::arrays::{Numbers, as_array, as_table, vectors};
use crate::experiment::Experiment;
use crate::failure::{invalid, raised};
use crate::motion::{Motion, Nodes, nodes};
use crate::options::{budget, parsed};
use crate::work::{How, Run, run, run_as};
use calibrant::design::poses::{PoseDesign as FoundPoses, evaluate_poses};
use calibrant::design::{Design as FoundDesign, DesignStatus, assess as assessed, evaluate};
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{
    CriterionLetter, DesignFile, DesignSetting, EarlierCalibration, EvaluationFile, PoseDesignFile,
    PoseEvaluationFile, parse_calibration, to_json,
};
use calibrant::machine_design::TrajectoryDesign;
use calibrant::report::{About, design_sheet, evaluation_sheet, pose_sheet, trajectory_sheet};
use calibrant::session::MotionSource;
use calibrant::{DesignChoice, DesignPlan, Result, TrajectoryPlan, rest_remark, undetermined_by};
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Choice {
    /// The texts of earlier calibrations.
    known: Vec<String>,
    criterion: Option<String>,
    starts: Option<usize>,
    seconds: Option<f64>,
    seed: Option<u64>,
    without_certificate: bool,
    gap: Option<f64>,
    force: bool,
}

impl Choice {
    fn earlier(&self) -> Result<Vec<EarlierCalibration>> {
        self.known.iter().map(|text| parse_calibration(text.as_bytes())).collect()
    }

    fn of(&self, given: &Run) -> Result<DesignChoice> {
        let letter = |text: &String| {
            let found =
                CriterionLetter::ALL.into_iter().find(|letter| letter.name().eq_ignore_ascii_case(text));
            found.ok_or_else(|| invalid(format!("`criterion` is {text:?}"), "give A, D, E, M, c or I"))
        };
        if let Some(gap) = self.gap.filter(|gap| !(*gap > 0.0 && *gap < 1.0)) {
            return Err(invalid(format!("`gap` is {gap}"), "give a share between 0 and 1, such as 0.01"));
        }
        if let Some(seconds) = self.seconds.filter(|of| !(of.is_finite() && *of > 0.0)) {
            return Err(invalid(format!("`seconds` is {seconds}"), "give a number above 0"));
        }
        Ok(DesignChoice {
            criterion: self.criterion.as_ref().map(letter).transpose()?,
            starts: self.starts,
            seconds: self.seconds,
            seed: self.seed,
            without_certificate: self.without_certificate,
            gap: self.gap,
            budget: budget(self.force),
            interruption: given.interruption.clone(),
        })
    }

    fn plan(&self, experiment: &Experiment, given: &Run) -> Result<DesignPlan> {
        DesignPlan::new(experiment.read.clone(), self.earlier()?, &self.of(given)?)
    }
}

/// Tells of steps, each of which is one more.
fn counter(given: &Run, what: &'static str, of: u64) -> impl Fn(u64) + Sync + use<> {
    let (progress, done) = (given.progress.clone(), AtomicU64::new(0));
    move |more| {
        let done = done.fetch_add(more, Ordering::Relaxed) + more;
        progress.tell(what, done, of.max(done));
    }
}

/// The best motion, or a motion beside it.
#[pyclass(frozen)]
pub(crate) struct Design {
    design: Option<Arc<FoundDesign>>,
    json: String,
    text: String,
    html: String,
    notes: Vec<Diagnostic>,
}

#[pymethods]
impl Design {
    /// The text of `design.json`, or of `evaluation.json`.
    fn json(&self) -> &str {
        &self.json
    }

    fn text(&self) -> &str {
        &self.text
    }

    fn html(&self) -> &str {
        &self.html
    }

    fn notes(&self) -> String {
        json!(self.notes).to_string()
    }

    /// The nodes of the best motion.
    fn nodes<'py>(&self, py: Python<'py>) -> Option<Nodes<'py>> {
        self.design.as_ref().map(|of| nodes(py, &of.optimal.motion))
    }

    /// Value, bound, gap of the best motion, and whether the search was interrupted.
    fn value(&self) -> Option<(f64, Option<f64>, Option<f64>, bool)> {
        let of = self.design.as_ref()?;
        let (bound, gap) = of.certificate.as_ref().map(|bound| (bound.lower_bound, bound.gap)).unzip();
        Some((of.optimal.value, bound, gap, of.status == DesignStatus::Interrupted))
    }
}

/// Finds the best motion.
#[pyfunction]
#[pyo3(signature = (experiment, choice, *, threads=None, progress=None, width=100))]
pub(crate) fn design(
    py: Python<'_>,
    experiment: &Experiment,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    width: usize,
) -> PyResult<Design> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: true }, move |given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(&experiment, &given)?;
        let problem = plan.problem().map_err(&placed)?;
        let mut notes = plan.notes.clone();
        notes.extend(rest_remark(problem.limits));
        let steps = (plan.settings.starts * problem.sensor.axes) as u64;
        let found = plan.design(&problem, &counter(&given, "starts", steps)).map_err(&placed)?;
        notes.extend(plan.remarks(&found));
        let setting = DesignSetting { problem: &problem, settings: &plan.settings };
        let json = to_json(&DesignFile { design: &found, reached: None, setting });
        let about = About { title: "Design of a motion".into(), ..About::default() };
        let sheet = design_sheet(&found, &about);
        let (text, html) = (sheet.text(width), sheet.html());
        drop(sheet);
        Ok(Design { json, text, html, notes, design: Some(Arc::new(found)) })
    })
}

/// Puts a motion beside the best one.
#[pyfunction]
#[pyo3(signature = (experiment, motion, choice, *, threads=None, progress=None, width=100))]
pub(crate) fn assess(
    py: Python<'_>,
    experiment: &Experiment,
    motion: &Motion,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    width: usize,
) -> PyResult<Design> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let (experiment, source) = (experiment.clone(), motion.0.clone());
    run_as(py, How { threads, progress, keeps_the_best: true }, move |given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(&experiment, &given)?;
        let problem = plan.problem().map_err(&placed)?;
        let motion = match &source {
            MotionSource::File(path) => calibrant::io::read_motion(path, problem.sensor.axes)?,
            MotionSource::Commanded(motion) => motion.clone(),
            MotionSource::Logged(_) | MotionSource::OnKnots(..) => {
                return Err(invalid("a log of a machine is no commanded motion", "give the nodes of one"));
            }
        };
        // errors of the motion itself come before the search
        evaluate(&problem, &motion)?;
        let steps = (plan.settings.starts * problem.sensor.axes) as u64;
        let optimum = match plan.design(&problem, &counter(&given, "starts", steps)) {
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
        let sheet = evaluation_sheet(&found, &about);
        let (text, html) = (sheet.text(width), sheet.html());
        drop(sheet);
        Ok(Design { json, text, html, notes, design: found.optimum.ok().map(Arc::new) })
    })
}

/// The best poses.
#[pyclass(frozen)]
pub(crate) struct PoseDesign {
    found: FoundPoses,
    json: String,
    text: String,
    html: String,
    notes: Vec<Diagnostic>,
}

#[pymethods]
impl PoseDesign {
    fn json(&self) -> &str {
        &self.json
    }

    fn text(&self) -> &str {
        &self.text
    }

    fn html(&self) -> &str {
        &self.html
    }

    fn notes(&self) -> String {
        json!(self.notes).to_string()
    }

    /// Their directions, unit vectors: the axis that is up in each.
    fn directions<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        as_table(py, &self.found.directions)
    }
}

/// Finds the best poses.
#[pyfunction]
#[pyo3(signature = (experiment, poses, choice, *, threads=None, progress=None, width=100))]
pub(crate) fn design_poses(
    py: Python<'_>,
    experiment: &Experiment,
    poses: Option<usize>,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    width: usize,
) -> PyResult<PoseDesign> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: true }, move |given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(&experiment, &given)?;
        let problem = plan.pose_problem(poses).map_err(&placed)?;
        let steps = plan.settings.starts as u64;
        let found = plan.design_poses(&problem, &counter(&given, "starts", steps)).map_err(&placed)?;
        let unit = experiment.read.sensor.unit;
        let json = to_json(&PoseDesignFile { design: &found, reached: None, problem: &problem, unit });
        let about = About { title: "Poses for a static calibration".into(), ..About::default() };
        let sheet = pose_sheet(&found, &problem, unit, &about);
        let (text, html) = (sheet.text(width), sheet.html());
        drop(sheet);
        Ok(PoseDesign { json, text, html, notes: plan.notes.clone(), found })
    })
}

/// Puts poses beside the best ones: the text of `evaluation.json`.
#[pyfunction]
pub(crate) fn assess_poses(
    py: Python<'_>,
    experiment: &Experiment,
    directions: &[u8],
    choice: &str,
) -> PyResult<String> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let directions = vectors(directions);
    let experiment = experiment.clone();
    run_as(py, How::default(), move |given| {
        let plan = choice.plan(&experiment, &given)?;
        let problem = plan.pose_problem(Some(directions.len()));
        let problem = problem.map_err(Experiment::placed(&experiment.file))?;
        let evaluation = evaluate_poses(&problem, &directions, plan.settings.seed)?;
        let unit = experiment.read.sensor.unit;
        Ok(to_json(&PoseEvaluationFile {
            evaluation: &evaluation,
            problem: &problem,
            directions: &directions,
            unit,
        }))
    })
}

/// The best trajectory of a machine.
#[pyclass(frozen)]
pub(crate) struct Trajectory {
    found: Arc<(TrajectoryPlan, TrajectoryDesign)>,
    json: String,
    text: String,
    html: String,
    notes: Vec<Diagnostic>,
}

#[pymethods]
impl Trajectory {
    fn json(&self) -> &str {
        &self.json
    }

    fn text(&self) -> &str {
        &self.text
    }

    fn html(&self) -> &str {
        &self.html
    }

    fn notes(&self) -> String {
        json!(self.notes).to_string()
    }

    /// Did an interruption end the search?
    fn interrupted(&self) -> bool {
        self.found.1.status == DesignStatus::Interrupted
    }

    /// Names of the joints, times of the waypoints, positions.
    fn waypoints<'py>(&self, py: Python<'py>) -> (Vec<String>, Numbers<'py>, Numbers<'py>) {
        let (plan, design) = self.found.as_ref();
        let names = plan.machine.chain.joints.iter().map(|joint| joint.name.clone()).collect();
        let motion = &design.optimal.motion;
        let times: Vec<f64> =
            (0..=motion.knots.intervals).map(|number| motion.knots.knot_s(number)).collect();
        let positions: Vec<f64> = times.iter().flat_map(|time_s| motion.at(*time_s, 0)).collect();
        (names, as_array(py, &times), as_array(py, &positions))
    }

    /// Writes the files of `calibrant design`, without its report.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<Vec<PathBuf>> {
        let found = Arc::clone(&self.found);
        run(py, move || found.0.write(&found.1, &directory, None))
    }
}

/// Finds the best trajectory of a machine.
#[pyfunction]
#[pyo3(signature = (experiment, choice, *, threads=None, progress=None, width=100))]
pub(crate) fn design_trajectory(
    py: Python<'_>,
    experiment: &Experiment,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    width: usize,
) -> PyResult<Trajectory> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: true }, move |given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = TrajectoryPlan::new(experiment.read.clone(), &choice.of(&given)?).map_err(&placed)?;
        let plan = plan.with_progress(given.progress);
        let found = plan.design().map_err(&placed)?;
        let mut notes = plan.notes();
        notes.extend(plan.remarks(&found));
        let problem = plan.problem();
        let json = to_json(&plan.file(&found, &problem, None));
        let about = About { title: "Trajectory of a machine".into(), ..About::default() };
        let sheet = trajectory_sheet(&found, (&problem, &plan.world), &about);
        let (text, html) = (sheet.text(width), sheet.html());
        drop(sheet);
        drop(problem);
        Ok(Trajectory { json, text, html, notes, found: Arc::new((plan, found)) })
    })
}
