//! Trajectories of a machine: the best one, one beside it, the best of several durations.

use crate::arrays::{Numbers, as_array};
use crate::choice::{Choice, chosen, teller};
use crate::experiment::Experiment;
use crate::failure::invalid;
use crate::motion::{Log, Motion, log};
use crate::page::{Page, page};
use crate::series::series;
use crate::work::{Run, run};
use calibrant::design::{DesignStatus, SweepVariable};
use calibrant::diagnostic::design::MotionNotCompared;
use calibrant::diagnostic::{Diagnostic, Phrase};
use calibrant::error::Refusal;
use calibrant::io::{Reached, Trajectory as Path, TrajectoryEvaluationFile, TrajectorySweepFile, to_json};
use calibrant::machine_design::{TrajectoryDesign, TrajectoryEvaluation};
use calibrant::report::{About, trajectory_evaluation_sheet, trajectory_sheet, trajectory_sweep_sheet};
use calibrant::{ReachedDesign, Result, TrajectoryPlan};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The best trajectory of a machine.
#[pyclass(frozen)]
pub(crate) struct Trajectory(Arc<Found>);

struct Found {
    plan: TrajectoryPlan,
    design: TrajectoryDesign,
    reached: Option<Reached>,
}

/// Names of the joints, times of the knots, positions, velocities.
type Knots<'py> = (Vec<String>, Numbers<'py>, Numbers<'py>, Numbers<'py>);

fn knots<'py>(py: Python<'py>, plan: &TrajectoryPlan, of: &TrajectoryEvaluation) -> Knots<'py> {
    let names = plan.machine.chain.joints.iter().map(|joint| joint.name.clone()).collect();
    let spline = &of.motion;
    let times: Vec<f64> = (0..=spline.knots.intervals).map(|number| spline.knots.knot_s(number)).collect();
    let at = |derivative| times.iter().flat_map(|time_s| spline.at(*time_s, derivative)).collect::<Vec<_>>();
    (names, as_array(py, &times), as_array(py, &at(0)), as_array(py, &at(1)))
}

#[pymethods]
impl Trajectory {
    /// Did an interruption, or the time, end the search?
    fn interrupted(&self) -> bool {
        self.0.design.status == DesignStatus::Interrupted
    }

    /// The best trajectory at its knots.
    fn knots<'py>(&self, py: Python<'py>) -> Knots<'py> {
        knots(py, &self.0.plan, &self.0.design.optimal)
    }

    /// The plain routine at its knots.
    fn plain<'py>(&self, py: Python<'py>) -> Option<Knots<'py>> {
        let plain = self.0.design.plain.as_ref()?;
        Some(knots(py, &self.0.plan, &plain.evaluation))
    }

    /// What a machine logs that follows it, and the distance of its knots, s.
    fn log<'py>(&self, py: Python<'py>) -> (Log<'py>, f64) {
        let motion = &self.0.design.optimal.motion;
        let path = Path::of(&self.0.plan.machine.chain, motion.clone());
        (log(py, &path.log()), motion.knots.step_s)
    }

    /// Writes the files of `calibrant design`, without its report.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<Vec<PathBuf>> {
        let found = Arc::clone(&self.0);
        run(py, move || found.plan.write(&found.design, &directory, found.reached.as_ref()))
    }
}

/// Finds the best trajectory of a machine, or the shortest that reaches goals. `slow`: how many times slower it is then.
#[pyfunction]
#[pyo3(signature = (experiment, choice, *, slow=None, threads=None, progress=None))]
pub(crate) fn design_trajectory(
    py: Python<'_>,
    experiment: &Experiment,
    choice: &str,
    slow: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Page, Trajectory)> {
    chosen(py, experiment, choice, (threads, progress), move |experiment, choice, given| {
        let placed = Experiment::placed(&experiment.file);
        if let Some(times) = slow.filter(|times| !(1.0..=1000.0).contains(times)) {
            return Err(invalid(format!("`slow` is {times}"), "give a number from 1 to 1000"));
        }
        let plan = choice.trajectory_plan(experiment, given)?;
        let mut notes = plan.notes();
        let goals = choice.reach()?;
        if slow.is_some() && !goals.is_empty() {
            return Err(invalid("`slow` and `reach` are both there", "leave one of them away"));
        }
        let (mut plan, mut design, reached) = if goals.is_empty() {
            let plan = plan.with_progress(given.progress.clone());
            let design = plan.design().map_err(&placed)?;
            (plan, design, None)
        } else {
            let found = plan.reach(&goals, &teller(given, "durations", 0)).map_err(&placed)?;
            let (plan, ReachedDesign { design, reached, sentence }) = found;
            (plan, design, Some((reached, sentence)))
        };
        let mut title = "Trajectory of a machine".to_owned();
        if let Some(times) = slow {
            title += &format!(", {times} times slower");
            design = plan.slowed_design(&design, times)?;
            plan.machine.duration_s *= times;
        }
        notes.extend(plan.remarks(&design));
        let (reached, sentence) = reached.unzip();
        let problem = plan.problem();
        let json = to_json(&plan.file(&design, &problem, reached.as_ref()));
        let about = About { title, findings: sentence.into_iter().collect(), ..About::default() };
        let page = page(json, &notes, &trajectory_sheet(&design, (&problem, &plan.world), &about));
        drop(problem);
        Ok((page, Trajectory(Arc::new(Found { plan, design, reached }))))
    })
}

/// Puts a trajectory beside the best one.
#[pyfunction]
#[pyo3(signature = (experiment, motion, choice, *, threads=None, progress=None))]
pub(crate) fn assess_trajectory<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    motion: &Motion,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Page, bool, Option<Knots<'py>>)> {
    let (motion, how) = (motion.0.clone(), (threads, progress));
    let (page, is_proved, plan, best) =
        chosen(py, experiment, choice, how, move |experiment, choice, given| {
            let plan = choice.trajectory_plan(experiment, given)?;
            let mut notes = plan.notes();
            let evaluation = plan.evaluate(&motion)?;
            let plan = plan.with_progress(given.progress.clone());
            let best = match plan.design() {
                Ok(design) => Some(design),
                Err(error) if error.code() == Refusal::Interrupted => return Err(error),
                Err(why) => {
                    notes.push(Diagnostic::from(MotionNotCompared { why: Phrase(why.to_string()) }));
                    None
                }
            };
            let problem = plan.problem();
            let file = TrajectoryEvaluationFile {
                evaluation: &evaluation,
                design: best.as_ref(),
                problem: &problem,
                plan: &plan.machine,
                world: &plan.world,
            };
            let json = to_json(&file);
            let about = About { title: "Assessment of a trajectory".into(), ..About::default() };
            let optimal = best.as_ref().map(|best| &best.optimal);
            let sheet = trajectory_evaluation_sheet(&evaluation, optimal, (&problem, &plan.world), &about);
            let page = page(json, &notes, &sheet);
            drop(sheet);
            drop(problem);
            Ok((page, evaluation.is_proved(), plan, best))
        })?;
    Ok((page, is_proved, best.map(|best| knots(py, &plan, &best.optimal))))
}

/// The best trajectories of several durations.
pub(crate) fn sweep(
    experiment: &Experiment,
    (variable, values): (SweepVariable, &[f64]),
    choice: &Choice,
    given: &Run,
) -> Result<Page> {
    let plan = choice.trajectory_plan(experiment, given)?;
    let swept = plan.sweep(variable, values, &teller(given, "durations", values.len()))?;
    let mut notes = plan.notes();
    notes.extend(series(given, swept.points.len(), values.len())?);
    let json = to_json(&TrajectorySweepFile { sweep: &swept });
    let about = About { title: "Trajectories of several durations".into(), ..About::default() };
    Ok(page(json, &notes, &trajectory_sweep_sheet(&swept, &about)))
}
