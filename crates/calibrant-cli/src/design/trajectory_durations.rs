//! `calibrant design` of a machine for several durations: `--sweep duration`, and the shortest one by `--reach`.

use super::Arguments;
use super::sweep_request::Request;
use super::trajectory_output::{about, finish};
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::TrajectoryPlan;
use calibrant::diagnostic::design::SeriesInterrupted;
use calibrant::io::{TrajectorySweepFile, to_json, write_json, write_text, write_trajectory_sweep_csv};
use calibrant::report::trajectory_sweep_sheet;

pub(super) fn sweep(
    arguments: &Arguments,
    plan: &TrajectoryPlan,
    request: &Request,
) -> calibrant::Result<Exit> {
    let bar = console::progress(request.values.len() as u64, "durations");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let swept = plan.sweep(request.of_motion()?, &request.values, &|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let swept = swept?;
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
    console::result(arguments.json, || to_json(&file), &sheet, None, &files)?;
    let good = swept.points.iter().any(|point| point.outcome.is_ok());
    Ok(if good { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

pub(super) fn reach(arguments: &Arguments, plan: TrajectoryPlan) -> calibrant::Result<Exit> {
    let bar = console::spinner("durations");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let found = plan.reach(&arguments.reach, &|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let (plan, found) = found.map_err(|error| error.in_experiment(&arguments.experiment))?;
    finish(arguments, &plan, found.design, Some((&found.reached, &found.sentence)))
}
