//! What is chosen of a design, which comes as JSON.

use crate::experiment::Experiment;
use crate::failure::{invalid, raised};
use crate::options::{budget, parsed, positive};
use crate::work::{How, Run, run_as};
use calibrant::error::{InputError, Refusal};
use calibrant::io::{
    CriterionLetter, EarlierCalibration, EarlierMachine, parse_calibration, parse_earlier_machine,
};
use calibrant::{DesignChoice, DesignPlan, Error, GoalRequest, Result, TrajectoryPlan};
use pyo3::prelude::*;
use serde::Deserialize;
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Choice {
    /// The texts of earlier calibrations.
    known: Vec<String>,
    criterion: Option<String>,
    starts: Option<usize>,
    seconds: Option<f64>,
    seed: Option<u64>,
    without_certificate: bool,
    gap: Option<f64>,
    /// Parameters, and the standard deviations that they should have.
    reach: Vec<(String, String)>,
    force: bool,
}

impl Choice {
    /// The goals.
    pub(crate) fn reach(&self) -> Result<Vec<GoalRequest>> {
        let goal = |(name, value): &(String, String)| {
            let refused = |why| invalid(format!("`reach`: {why}"), "give {\"scale.x\": \"50ppm\"}");
            GoalRequest::of(name, value).map_err(refused)
        };
        self.reach.iter().map(goal).collect()
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
        if self.starts == Some(0) {
            return Err(invalid("`starts` is 0", "give a number from 1"));
        }
        if self.gap.is_some() && (self.without_certificate || !self.reach.is_empty()) {
            let message = "`gap` needs the bound, and ends one search";
            let help = "leave away `gap`, or `certificate=False` and `reach`";
            let input_error = InputError::new(Refusal::OptionsContradict, message, help);
            return Err(Error::experiment(input_error));
        }
        Ok(DesignChoice {
            criterion: self.criterion.as_ref().map(letter).transpose()?,
            starts: self.starts,
            seconds: positive("seconds", self.seconds)?,
            seed: self.seed,
            without_certificate: self.without_certificate,
            gap: self.gap,
            budget: budget(self.force),
            interruption: given.interruption.clone(),
        })
    }

    /// The design of a motion or of poses.
    pub(crate) fn plan(&self, experiment: &Experiment, given: &Run) -> Result<DesignPlan> {
        let earlier = self.known.iter().map(|text| parse_calibration(text.as_bytes()));
        let earlier = earlier.collect::<Result<Vec<EarlierCalibration>>>()?;
        DesignPlan::new(experiment.read.clone(), earlier, &self.of(given)?)
    }

    /// The design of the trajectory of a machine.
    pub(crate) fn trajectory_plan(&self, experiment: &Experiment, given: &Run) -> Result<TrajectoryPlan> {
        let earlier: Option<EarlierMachine> = match self.known.as_slice() {
            [] => None,
            [text] => Some(parse_earlier_machine(text.as_bytes())?),
            _ => {
                let message = "`known` has several calibrations";
                return Err(invalid(message, "give the last one: a machine is as that found it"));
            }
        };
        let plan = TrajectoryPlan::after(experiment.read.clone(), &self.of(given)?, earlier.as_ref());
        plan.map_err(Experiment::placed(&experiment.file))
    }
}

/// Runs the work of a design. What it has found so far is kept when it is interrupted.
pub(crate) fn chosen<T: Send + 'static>(
    py: Python<'_>,
    experiment: &Experiment,
    choice: &str,
    (threads, progress): (Option<usize>, Option<Py<PyAny>>),
    work: impl FnOnce(&Experiment, &Choice, &Run) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let choice: Choice = parsed(choice).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    let how = How { threads, progress, keeps_the_best: true };
    run_as(py, how, move |given| work(&experiment, &choice, &given))
}

/// Adds up steps that are finished, and tells their number.
pub(crate) fn counter(given: &Run, what: &'static str, of: u64) -> impl Fn(u64) + Sync + use<> {
    let (progress, done) = (given.progress.clone(), AtomicU64::new(0));
    move |more| {
        let done = done.fetch_add(more, Ordering::Relaxed) + more;
        progress.tell(what, done, of.max(done));
    }
}

/// Tells how many steps are done.
pub(crate) fn teller(given: &Run, what: &'static str, of: usize) -> impl Fn(usize) + Sync + use<> {
    let progress = given.progress.clone();
    move |done| progress.tell(what, done as u64, of.max(done) as u64)
}
