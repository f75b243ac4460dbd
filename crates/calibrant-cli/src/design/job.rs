//! The design problem that the experiment file and the options describe.

use super::arguments::Arguments;
use crate::diagnostics::tell;
use crate::{budget, console, interruption};
use calibrant::Error;
use calibrant::design::{Design, DesignProblem, DesignSettings, design};
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::design::{CalibrationsApart, CalibrationsEqual};
use calibrant::error::{InputError, Refusal};
use calibrant::io::{EarlierCalibration, Experiment, Prior, read_calibration};
use calibrant::report::{About, number_format};
use std::path::Path;

/// The experiment, the options and what follows from them.
pub(super) struct Job {
    pub(super) experiment: Experiment,
    pub(super) earlier: Vec<EarlierCalibration>,
    pub(super) settings: DesignSettings,
}

impl Job {
    pub(super) fn prepare(arguments: &Arguments) -> calibrant::Result<Self> {
        let mut experiment = Experiment::read(&arguments.experiment)?;
        if let Some(letter) = arguments.criterion {
            experiment.design.criterion = letter;
        }
        let earlier: Vec<_> =
            arguments.from.iter().map(|path| read_calibration(path)).collect::<Result<_, _>>()?;
        warn_of_strangers(&earlier);
        let otherwise = experiment.design_settings();
        let settings = DesignSettings {
            starts: arguments.starts.map_or(otherwise.starts, |starts| starts as usize),
            seconds: arguments.seconds,
            seed: arguments.seed.unwrap_or(otherwise.seed),
            certificate: otherwise.certificate && !arguments.no_certificate,
            gap: arguments.gap,
            interruption: interruption::keeping_the_best(),
            ..otherwise
        };
        if settings.gap.is_some() && !settings.certificate {
            let message = "--gap asks for a proof, and the experiment wants no bound";
            let help = "set certificate = true in [design], or leave --gap away";
            return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
        }
        Ok(Self { experiment, earlier, settings })
    }

    pub(super) fn problem(&self, file: &Path) -> calibrant::Result<DesignProblem<'_>> {
        self.experiment.design_problem(&self.earlier).map_err(|error| in_file(error, file))
    }

    /// The context of the report on the design.
    pub(super) fn about(&self, arguments: &Arguments, problem: &DesignProblem<'_>, title: String) -> About {
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
            fact("Starts", format!("{}, seed {}", self.settings.starts, self.settings.seed)),
        ];
        for path in &arguments.from {
            facts.push(fact("Known before", path.display().to_string()));
        }
        if self.experiment.calibrate.prior == Prior::Datasheet {
            facts.push(fact("Prior", "datasheet".into()));
        }
        About {
            title,
            facts,
            program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
            ..About::default()
        }
    }

    /// Checks that the search fits into the budget.
    pub(super) fn check_work(&self, problem: &DesignProblem<'_>) -> calibrant::Result<()> {
        let what = format!("{} starts of {} intervals", self.settings.starts, problem.intervals);
        budget::check(self.settings.work(problem), &what, "take fewer starts or intervals")
    }

    /// Solves the problem, with a progress bar over its starts.
    pub(super) fn design(&self, problem: &DesignProblem<'_>) -> calibrant::Result<Design> {
        self.check_work(problem)?;
        let bar = console::progress((self.settings.starts * problem.sensor.axes) as u64, "starts");
        bar.set_message(self.standing(problem));
        bar.enable_steady_tick(std::time::Duration::from_millis(200));
        let outcome = design(problem, &self.settings, &|done| {
            bar.inc(done);
            bar.set_message(self.standing(problem));
        });
        bar.finish_and_clear();
        outcome
    }

    /// The best value so far, and the gap to the bound, in a few words.
    fn standing(&self, problem: &DesignProblem<'_>) -> String {
        let so_far = &self.settings.so_far;
        let shown = |value: f64| number_format::significant(value, 5);
        let value = so_far.value(&problem.criterion);
        let best = value.map(|value| format!("best {}", shown(value)));
        let bound = match (so_far.bound(), value) {
            (Some(bound), Some(value)) => Some(format!(
                "gap {}",
                super::table::gap(
                    &problem.criterion,
                    problem.criterion.gap(value - problem.floor(), bound - problem.floor())
                )
            )),
            (Some(bound), None) => Some(format!("bound {}", shown(bound))),
            (None, _) => self.settings.certificate.then(|| "bound …".to_owned()),
        };
        best.into_iter().chain(bound).collect::<Vec<_>>().join(", ")
    }
}

/// Warns about earlier calibrations of different sensors, or the same calibration twice. Their information adds up.
fn warn_of_strangers(earlier: &[EarlierCalibration]) {
    let name = |calibration: &EarlierCalibration| {
        Phrase(calibration.file.as_ref().map_or_else(String::new, |file| file.display().to_string()))
    };
    for (number, calibration) in earlier.iter().enumerate() {
        let same = |other: &&EarlierCalibration| {
            other.values == calibration.values && other.covariance == calibration.covariance
        };
        if let Some(other) = earlier[..number].iter().find(same) {
            tell(CalibrationsEqual { one: name(other), other: name(calibration) });
        }
    }
    let Some((last, others)) = earlier.split_last() else { return };
    for other in others {
        let degrees_of_freedom = last.values.len() as f64;
        // significant: mean and variance of χ² are k and 2k
        let most = degrees_of_freedom + 6.0 * (2.0 * degrees_of_freedom).sqrt();
        if let Some(chi2) = last.chi2_against(other).filter(|chi2| *chi2 > most) {
            let parameters = last.values.len();
            tell(CalibrationsApart { one: name(other), other: name(last), chi2, parameters });
        }
    }
}

/// Names the experiment file in an error about its limits, or about a key of it.
pub(super) fn in_file(error: Error, file: &Path) -> Error {
    let named = |input_error: Box<InputError>| {
        if input_error.file.is_none() { Box::new(input_error.in_file(file)) } else { input_error }
    };
    match error {
        Error::Experiment(input_error) if input_error.key.is_some() => Error::Experiment(named(input_error)),
        Error::Infeasible(input_error) => Error::Infeasible(named(input_error)),
        other => other,
    }
}
