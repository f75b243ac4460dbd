//! `calibrant design` of a machine for several durations: `--sweep duration`, and the shortest one by `--reach`.

use super::Arguments;
use super::reach_request;
use super::sweep_request::Request;
use super::trajectory_output::{about, finish};
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::TrajectoryPlan;
use calibrant::design::SweepVariable;
use calibrant::diagnostic::design::SeriesInterrupted;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{
    Reached, ReachedGoal, TrajectorySweepFile, to_json, write_json, write_text, write_trajectory_sweep_csv,
};
use calibrant::machine_design::{ShortestTrajectory, TrajectoryGoal, shortest_trajectory, sweep_durations};
use calibrant::report::number_format::{counted, significant};
use calibrant::report::trajectory_sweep_sheet;

/// Longest duration of a trajectory, s.
const LONGEST_S: f64 = 3600.0;

pub(super) fn sweep(
    arguments: &Arguments,
    plan: &TrajectoryPlan,
    request: &Request,
) -> calibrant::Result<Exit> {
    if request.variable != SweepVariable::Duration {
        let message =
            format!("a machine is swept over its duration, not over its {}", request.variable.name());
        let input_error = InputError::new(Refusal::ExperimentUnsuited, message, "--sweep duration=10,20,40");
        return Err(Error::experiment(input_error));
    }
    // as machine.design.duration_s may be
    if let Some(duration_s) =
        request.values.iter().find(|duration_s| !(1.0..=LONGEST_S).contains(*duration_s))
    {
        let message = format!("--sweep: a trajectory of {duration_s} s");
        let input_error =
            InputError::new(Refusal::ValueOutOfRange, message, "durations from 1 s, at most 3600 s");
        return Err(Error::experiment(input_error));
    }
    let bar = console::progress(request.values.len() as u64, "durations");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let problem = plan.problem();
    let swept =
        sweep_durations(&problem, &plan.settings, &request.values, &|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let (finished, all) = (swept.points.len(), request.values.len());
    if finished < all {
        tell(SeriesInterrupted { series: "sweep", items: "values", finished, all });
        if finished == 0 {
            return Ok(Exit::INTERRUPTED);
        }
    }
    let output = &arguments.output;
    let file = TrajectorySweepFile { sweep: &swept };
    write_json(&output.join("sweep.json"), &file)?;
    write_trajectory_sweep_csv(&output.join("sweep.csv"), &swept)?;
    let mut about = about(arguments, plan, "Trajectories of several durations".into());
    about.facts.retain(|(label, _)| label != "Duration");
    let sheet = trajectory_sweep_sheet(&swept, &about);
    write_text(&output.join("report.html"), &sheet.html())?;
    let files = ["sweep.csv", "report.html"].map(|name| output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, None, &files);
    let good = swept.points.iter().any(|point| point.outcome.is_ok());
    Ok(if good { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

pub(super) fn reach(arguments: &Arguments, plan: TrajectoryPlan) -> calibrant::Result<Exit> {
    let goals = reach_request::goals_of_imu(&arguments.reach, &plan.quantities)?;
    let bar = console::spinner("durations");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let found =
        shortest_trajectory(&plan.problem(), &plan.settings, &goals, &|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let ShortestTrajectory { duration_s, design, not_found_s } =
        found.map_err(|error| error.in_experiment(&arguments.experiment))?;
    let shorter = not_found_s.map_or_else(String::new, |not_found_s| {
        format!(
            " With {} s, none was found in {}.",
            significant(not_found_s, 3),
            counted(plan.settings.starts, "start")
        )
    });
    let wanted = reach_request::asked(&arguments.reach);
    let sentence = format!("A trajectory of {} s reaches {wanted}.{shorter}", significant(duration_s, 3));
    let name =
        |goal: &TrajectoryGoal| ReachedGoal { name: plan.quantities[goal.parameter].name(), sd: goal.sd };
    let reached = Reached { goals: goals.iter().map(name).collect(), at_least: None };
    let mut plan = plan;
    plan.machine.duration_s = duration_s;
    finish(arguments, &plan, design, Some((&reached, &sentence)))
}
