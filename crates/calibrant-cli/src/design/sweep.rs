//! `calibrant design --sweep`: designs the best motion for several values of one quantity.

use super::Arguments;
use super::job::about;
use super::sweep_request::Request;
use crate::diagnostics::{tell, tell_all};
use crate::exit::Exit;
use crate::{console, interruption};
use calibrant::design::{DesignProblem, DesignStatus};
use calibrant::diagnostic::design::SeriesInterrupted;
use calibrant::io::{DesignSetting, SweepFile, to_json, write_json, write_sweep_csv, write_text};
use calibrant::report::sweep_sheet;
use calibrant::{DesignPlan, sweep_remarks};

pub(super) fn run(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
    request: &Request,
) -> calibrant::Result<Exit> {
    let bar = console::progress(request.values.len() as u64, "values");
    let outcome =
        job.sweep(problem, request.of_motion()?, &request.values, &|number| bar.set_position(number as u64));
    bar.finish_and_clear();
    let swept = outcome.map_err(|error| error.in_experiment(&arguments.experiment))?;
    if interruption::is_asked() {
        let (finished, all) = (swept.points.len(), request.values.len());
        tell(SeriesInterrupted { series: "sweep", items: "values", finished, all });
        if finished == 0 {
            return Ok(Exit::INTERRUPTED);
        }
    }
    let setting = DesignSetting { problem, settings: &job.settings };
    let file = SweepFile { sweep: &swept, setting };
    write_json(&arguments.output.join("sweep.json"), &file)?;
    write_sweep_csv(&arguments.output.join("sweep.csv"), &swept)?;
    let title = format!("Best motions over the {}", swept.variable.name());
    let about = about(job, arguments, problem, title);
    let sheet = sweep_sheet(&swept, &about);
    write_text(&arguments.output.join("report.html"), &sheet.html())?;
    tell_all(&sweep_remarks(&swept));
    let files = ["sweep.csv", "report.html"].map(|name| arguments.output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, None, &files)?;
    let good = |point: &calibrant::design::SweepPoint| {
        point.outcome.as_ref().is_ok_and(|design| design.optimal.covariance.is_some())
    };
    let converged = swept
        .points
        .iter()
        .all(|point| point.outcome.as_ref().map_or(true, |design| design.status == DesignStatus::Converged));
    Ok(if converged && swept.points.iter().any(good) { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}
