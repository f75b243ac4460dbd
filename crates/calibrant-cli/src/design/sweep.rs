//! `calibrant design --sweep`: what the best motion can do as one thing about the experiment changes.

use super::{Arguments, Job, in_file};
use crate::{Exit, console};
use calibrant::design::{DesignProblem, DesignStatus, Sweep, SweepVariable, sweep};
use calibrant::io::{sweep_json, write_atomically, write_sweep, write_sweep_csv};
use calibrant::report::number::{counted, short, significant};
use calibrant::report::sweep_report;

/// Most values of a sweep.
const MOST: usize = 1000;

/// What is swept, and over which values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Request {
    variable: SweepVariable,
    values: Vec<f64>,
}

/// Reads `duration=5,10,20`, `duration=5:40:8` (geometric) or `duration=5:40:8:linear`.
pub(crate) fn parse(text: &str) -> Result<Request, String> {
    let (name, values) =
        text.split_once('=').ok_or("write NAME=VALUES, for example duration=5,10,20 or velocity=2:20:6")?;
    let variable = SweepVariable::named(name.trim()).ok_or_else(|| {
        let names: Vec<_> = SweepVariable::ALL.iter().map(|variable| variable.name()).collect();
        format!("\"{name}\" cannot be swept; what can is {}", names.join(", "))
    })?;
    let number = |text: &str| {
        let number: Option<f64> = text.trim().parse().ok();
        number
            .filter(|value| value.is_finite() && *value > 0.0)
            .ok_or_else(|| format!("\"{}\" is not a number above 0", text.trim()))
    };
    let values = if values.contains(':') {
        let parts: Vec<&str> = values.split(':').collect();
        let linear = match parts.get(3) {
            None | Some(&"geometric") => false,
            Some(&"linear") => true,
            Some(word) => return Err(format!("\"{word}\" is neither linear nor geometric")),
        };
        let (&[from, to, count] | &[from, to, count, _]) = parts.as_slice() else {
            return Err("a range is FROM:TO:COUNT or FROM:TO:COUNT:linear".into());
        };
        let (from, to) = (number(from)?, number(to)?);
        let count: usize = count
            .trim()
            .parse()
            .ok()
            .filter(|count| (2..=MOST).contains(count))
            .ok_or(format!("\"{}\" is not a number of values from 2 to {MOST}", count.trim()))?;
        let last = (count - 1) as f64;
        let value = |k: usize| {
            let x = k as f64 / last;
            match k {
                0 => from,
                k if k + 1 == count => to,
                _ if linear => from + (to - from) * x,
                _ => from * (to / from).powf(x),
            }
        };
        (0..count).map(value).collect()
    } else {
        values.split(',').map(number).collect::<Result<Vec<_>, _>>()?
    };
    if values.len() > MOST {
        return Err(format!("{} values; at most {MOST}", values.len()));
    }
    Ok(Request { variable, values })
}

pub(super) fn run(
    arguments: &Arguments,
    job: &Job,
    problem: &DesignProblem<'_>,
    request: &Request,
) -> calibrant::Result<Exit> {
    let bar = console::progress(request.values.len() as u64, "values");
    let outcome = sweep(problem, &job.settings, request.variable, &request.values, &|number, _| {
        bar.set_position(number as u64);
    });
    bar.finish_and_clear();
    let swept = outcome.map_err(|error| in_file(error, &arguments.experiment))?;
    write_sweep(&arguments.output.join("sweep.json"), &swept, problem, &job.settings)?;
    write_sweep_csv(&arguments.output.join("sweep.csv"), &swept)?;
    let title = format!("Best motions over the {}", swept.variable.name());
    let html = sweep_report(&swept, &job.about(arguments, problem, title));
    write_atomically(&arguments.output.join("report.html"), |out| out.write_all(html.as_bytes()))?;
    say(&swept);
    if arguments.json {
        console::print(&sweep_json(&swept, problem, &job.settings));
    } else {
        console::print(&table(&swept));
        let output = &arguments.output;
        console::print(&format!(
            "\n{}\n{}\n",
            output.join("sweep.csv").display(),
            output.join("report.html").display()
        ));
    }
    let good = |point: &calibrant::design::SweepPoint| {
        point.outcome.as_ref().is_ok_and(|design| design.optimal.covariance.is_some())
    };
    let converged = swept
        .points
        .iter()
        .all(|point| point.outcome.as_ref().map_or(true, |design| design.status == DesignStatus::Converged));
    Ok(if converged && swept.points.iter().any(good) { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

/// Notes and warnings about single values.
fn say(swept: &Sweep) {
    let (name, unit) = (swept.variable.name(), swept.variable.unit());
    for point in &swept.points {
        if (point.value - point.asked).abs() > 1e-9 * point.asked {
            console::note(&format!(
                "{name} {} {unit} is not a whole number of intervals: {} {unit}, {}, instead",
                short(point.asked),
                short(point.value),
                counted(point.intervals, "interval")
            ));
        }
        match &point.outcome {
            Err(why) => console::warn(&format!("{name} {} {unit}: {why}", short(point.value))),
            Ok(design) if design.status != DesignStatus::Converged => console::warn(&format!(
                "{name} {} {unit}: the search ended as \"{}\"; a better motion may be near",
                short(point.value),
                design.status.name()
            )),
            Ok(_) => (),
        }
    }
}

fn table(swept: &Sweep) -> String {
    let label = format!("{} {}", swept.variable.name(), swept.variable.unit());
    let criterion = format!("criterion {}", swept.criterion.letter());
    let sds: Vec<String> =
        swept.parameters.iter().map(|parameter| format!("sd {}", parameter.name)).collect();
    let mut header = vec![label.as_str(), criterion.as_str(), "gap"];
    header.extend(sds.iter().map(String::as_str));
    let rows: Vec<_> = swept
        .points
        .iter()
        .map(|point| {
            let design = point.outcome.as_ref().ok();
            let cell = |value: Option<f64>, digits| {
                value.map_or_else(|| "–".into(), |value| significant(value, digits))
            };
            let gap = design.and_then(|design| design.certificate.as_ref()).map(|bound| bound.gap);
            let mut row = vec![
                short(point.value),
                cell(design.map(|design| design.optimal.value), 4),
                gap.map_or_else(|| "–".into(), |gap| super::table::gap(&swept.criterion, gap)),
            ];
            row.extend(point.sd(swept.parameters.len()).into_iter().map(|sd| cell(Some(sd), 3)));
            row
        })
        .collect();
    console::table(&header, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_lists_and_ranges() {
        let values = |text| parse(text).expect("good").values;
        assert_eq!(values("duration=5,10, 20"), [5.0, 10.0, 20.0]);
        assert_eq!(values("velocity=1:4:3"), [1.0, 2.0, 4.0]);
        assert_eq!(values("limits.jerk_mps3=1:4:4:linear"), [1.0, 2.0, 3.0, 4.0]);
        for (bad, says) in [
            ("duration", "write NAME=VALUES"),
            ("speed=1,2", "\"speed\" cannot be swept; what can is duration, acceleration"),
            ("duration=5,,10", "\"\" is not a number above 0"),
            ("duration=-5", "\"-5\" is not a number above 0"),
            ("duration=5:10", "a range is FROM:TO:COUNT"),
            ("duration=5:10:1", "\"1\" is not a number of values from 2 to 1000"),
            ("duration=5:10:3:log", "\"log\" is neither linear nor geometric"),
        ] {
            let said = parse(bad).expect_err("bad");
            assert!(said.contains(says), "{said}");
        }
    }
}
