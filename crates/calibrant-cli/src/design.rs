//! `calibrant design`: finds the motion whose recording determines the parameters best.

mod arguments;
mod campaign;
mod evaluate;
mod job;
mod output;
mod pose_evaluation;
mod pose_output;
mod poses;
mod reach;
mod sweep;
mod sweep_request;
mod trajectory;
mod trajectory_durations;
mod trajectory_output;

pub(crate) use arguments::Arguments;

use crate::diagnostics::tell_in;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::design::DesignProblem;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{Plan, ResultPlaces};

use output::{check_dense, finish};

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let names = [
            "design.json",
            "motion.csv",
            "poses.csv",
            "campaign.csv",
            "motion_dense.csv",
            "evaluation.json",
            "evaluation.html",
            "sweep.json",
            "sweep.csv",
            "report.html",
            "trajectory.csv",
            "plain_trajectory.csv",
            "follow_joint_trajectory.yaml",
            "trajectory.script",
        ];
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: names.map(|name| self.output.join(name)).to_vec(),
            inputs: std::iter::once(&self.experiment)
                .chain(&self.from)
                .chain(&self.evaluate)
                .cloned()
                .collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let job = job::prepare(arguments)?;
    let campaign = job.experiment.campaign().map_err(|error| error.in_experiment(&arguments.experiment))?;
    if let Some(campaign) = campaign {
        return campaign::run(arguments, &job, &campaign);
    }
    if arguments.add_min.is_some() {
        let (message, help) = (
            "--add-min is of a campaign over temperature, and this is none",
            "see `calibrant init campaign`",
        );
        return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    }
    if matches!(job.experiment.plan, Plan::Holds(_)) {
        return poses::run(arguments, &job);
    }
    if matches!(job.experiment.plan, Plan::Machine(_)) {
        return trajectory::run(arguments, job);
    }
    trajectory::refuse_its_options(arguments)?;
    if arguments.add.is_some() {
        let help = "--add is of poses, in a [holds] experiment";
        let message = "this experiment has no poses to add to";
        return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    }
    let problem = job.problem().map_err(|error| error.in_experiment(&arguments.experiment))?;
    calibrant::rest_remark(problem.limits).iter().for_each(|found| tell_in(found, None));
    check_dense(arguments, &problem)?;
    match (&arguments.evaluate, &arguments.sweep) {
        (Some(path), _) => evaluate::run(arguments, &job, &problem, path),
        (None, Some(request)) => sweep::run(arguments, &job, &problem, request),
        (None, None) if !arguments.reach.is_empty() => reach::run(arguments, &job, &problem),
        (None, None) => run_design(arguments, &job, &problem),
    }
}

fn run_design(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
) -> calibrant::Result<Exit> {
    let design = job::run(job, problem).map_err(|error| error.in_experiment(&arguments.experiment))?;
    finish(arguments, job, problem, &design, None)
}
