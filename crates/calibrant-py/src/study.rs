//! Studies of simulated sensors, and rehearsals of machines and campaigns.

use crate::choice::{counter, teller};
use crate::experiment::Experiment;
use crate::failure::invalid;
use crate::motion::Motion;
use crate::options::budget;
use crate::page::{Page, page};
use crate::work::{How, Run, run_as};
use calibrant::io::{CampaignStudyFile, Plan, StudyFile, to_json};
use calibrant::report::{About, campaign_study_sheet, study_sheet};
use calibrant::session::MotionSource;
use calibrant::study::Studies;
use calibrant::{CampaignStudy, DesignChoice, RehearsalPlan, Result, StudyChoice, StudyPlan, TrajectoryPlan};
use pyo3::prelude::*;

/// What is chosen in place of what the experiment says.
struct Choice {
    motion: Option<MotionSource>,
    sensors: Option<usize>,
    starts: Option<usize>,
    seed: Option<u64>,
    force: bool,
}

/// Runs the studies of an experiment; of a machine or a campaign its rehearsal.
#[pyfunction]
#[pyo3(signature = (experiment, *, motion=None, sensors=None, starts=None, seed=None, force=false, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "each is an argument of the Python function")]
pub(crate) fn study(
    py: Python<'_>,
    experiment: &Experiment,
    motion: Option<&Motion>,
    sensors: Option<usize>,
    starts: Option<usize>,
    seed: Option<u64>,
    force: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Page> {
    let choice = Choice { motion: motion.map(|motion| motion.0.clone()), sensors, starts, seed, force };
    let experiment = experiment.clone();
    // of a campaign, what is not finished is nothing
    let keeps_the_best = experiment.read.campaign_section().is_none();
    run_as(py, How { threads, progress, keeps_the_best }, move |given| {
        for (name, number) in [("sensors", choice.sensors), ("starts", choice.starts)] {
            if number == Some(0) {
                return Err(invalid(format!("`{name}` is 0"), "give a number from 1"));
            }
        }
        if experiment.read.campaign_section().is_some() {
            return campaign(&experiment, &choice, &given);
        }
        let studies = match experiment.read.plan {
            Plan::Machine(_) => rehearsed(&experiment, &choice, &given),
            _ => studied(&experiment, choice, &given),
        };
        let studies = studies.map_err(Experiment::placed(&experiment.file))?;
        let about = About::default();
        let json = to_json(&StudyFile { studies: &studies });
        Ok(page(json, &studies.notes, &study_sheet(&studies, &about)))
    })
}

/// The studies of a commanded motion.
fn studied(experiment: &Experiment, choice: Choice, given: &Run) -> Result<Studies> {
    let Choice { motion, sensors, starts, seed, force } = choice;
    let interruption = given.interruption.clone();
    let choice = StudyChoice { motion, sensors, seed, starts, budget: budget(force), interruption };
    let plan = StudyPlan::new(&experiment.read, &choice)?;
    plan.run(&counter(given, "sensors", plan.steps()))
}

/// The rehearsal of a campaign over temperature, and of the usual ones in its time.
fn campaign(experiment: &Experiment, choice: &Choice, given: &Run) -> Result<Page> {
    let refused = [("motion", choice.motion.is_some()), ("starts", choice.starts.is_some())];
    if let Some((name, _)) = refused.iter().find(|(_, is_there)| *is_there) {
        return Err(invalid(format!("`{name}` is not for a campaign over temperature"), "leave it away"));
    }
    let study = CampaignStudy::new(&experiment.read, choice.sensors, choice.seed);
    let found = study.run(teller(given, "sensors", study.sensors));
    let found = found.map_err(Experiment::placed(&experiment.file))?;
    Ok(page(to_json(&CampaignStudyFile(&found)), &[], &campaign_study_sheet(&found, &About::default())))
}

/// The rehearsal of a machine.
fn rehearsed(experiment: &Experiment, choice: &Choice, given: &Run) -> Result<Studies> {
    if choice.motion.is_some() {
        let message = "`motion` is of the study of a [motion] experiment";
        return Err(invalid(message, "leave it away: a rehearsal designs the motions of its machine"));
    }
    let interruption = given.interruption.clone();
    let of_design =
        DesignChoice { starts: choice.starts, interruption: interruption.clone(), ..DesignChoice::default() };
    let plan = TrajectoryPlan::new(experiment.read.clone(), &of_design)?;
    let design = plan.clone().with_progress(given.progress.clone()).design()?;
    let study = &experiment.read.study;
    let rehearsal = RehearsalPlan {
        plan: &plan,
        sensors: choice.sensors.unwrap_or(study.sensors),
        seed: choice.seed.unwrap_or(study.seed),
        interruption,
        budget: budget(choice.force),
    };
    rehearsal.run(&design, &counter(given, "sensors", rehearsal.sensors as u64))
}
