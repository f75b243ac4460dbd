//! The design that the experiment file and the options describe.

use super::arguments::Arguments;
use crate::budget::budget;
use crate::diagnostics::tell_all;
use crate::{console, interruption};
use calibrant::design::{Design, DesignProblem};
use calibrant::io::{Plan, Prior, read_calibration};
use calibrant::report::{About, gap_in_words, number_format};
use calibrant::{DesignChoice, DesignPlan};

/// Reads the experiment and the earlier calibrations.
pub(super) fn prepare(arguments: &Arguments) -> calibrant::Result<DesignPlan> {
    let experiment = arguments.settings.read(&arguments.experiment)?;
    // of a machine another part of the file counts
    let earlier = match experiment.plan {
        Plan::Machine(_) => Vec::new(),
        _ if experiment.campaign_section().is_some() => Vec::new(),
        _ => arguments.from.iter().map(|path| read_calibration(path)).collect::<Result<_, _>>()?,
    };
    let choice = DesignChoice {
        criterion: arguments.criterion,
        starts: arguments.starts.map(|starts| starts as usize),
        seconds: arguments.seconds,
        seed: arguments.seed,
        without_certificate: arguments.no_certificate,
        gap: arguments.gap,
        budget: budget(),
        interruption: interruption::keeping_the_best(),
    };
    let plan = DesignPlan::new(experiment, earlier, &choice)?;
    tell_all(&plan.notes);
    Ok(plan)
}

/// The context of the report on the design.
pub(super) fn about(
    job: &DesignPlan,
    arguments: &Arguments,
    problem: &DesignProblem<'_>,
    title: String,
) -> About {
    let fact = |label: &str, text: String| (label.to_owned(), text);
    let mut facts = vec![
        fact("Experiment", arguments.experiment.display().to_string()),
        fact(
            "Motion",
            format!(
                "{} of {} s, {} Hz, trust {}",
                number_format::counted(problem.intervals, "interval"),
                number_format::short(problem.interval_s),
                number_format::short(problem.rate_hz),
                problem.trust.name()
            ),
        ),
        fact("Starts", format!("{}, seed {}", job.settings.starts, job.settings.seed)),
    ];
    for path in &arguments.from {
        facts.push(fact("Known before", path.display().to_string()));
    }
    if job.experiment.calibrate.prior == Prior::Datasheet {
        facts.push(fact("Prior", "datasheet".into()));
    }
    About { title, facts, of_thesis: job.experiment.is_of_thesis(), ..About::default() }
}

/// Solves the problem, with a progress bar over its starts.
pub(super) fn run(job: &DesignPlan, problem: &DesignProblem<'_>) -> calibrant::Result<Design> {
    let bar = console::progress((job.settings.starts * problem.sensor.axes) as u64, "starts");
    bar.set_message(standing(job, problem));
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let outcome = job.design(problem, &|done| {
        bar.inc(done);
        bar.set_message(standing(job, problem));
    });
    bar.finish_and_clear();
    outcome
}

/// The best value so far, and the gap to the bound, in a few words.
fn standing(job: &DesignPlan, problem: &DesignProblem<'_>) -> String {
    let so_far = &job.settings.so_far;
    let shown = |value: f64| number_format::significant(value, 5);
    let value = so_far.value(&problem.criterion);
    let best = value.map(|value| format!("best {}", shown(value)));
    let bound = match (so_far.bound(), value) {
        (Some(bound), Some(value)) => Some(format!(
            "gap {}",
            gap_in_words(
                &problem.criterion,
                problem.criterion.gap(value - problem.floor(), bound - problem.floor())
            )
        )),
        (Some(bound), None) => Some(format!("bound {}", shown(bound))),
        (None, _) => job.settings.certificate.then(|| "bound …".to_owned()),
    };
    best.into_iter().chain(bound).collect::<Vec<_>>().join(", ")
}
