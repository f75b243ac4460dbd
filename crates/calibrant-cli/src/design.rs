//! `calibrant design`: the motion whose recording determines the parameters best.

mod evaluate;
mod sweep;
mod table;

use crate::{Exit, console, place};
use calibrant::Error;
use calibrant::design::{Design, DesignProblem, DesignSettings, DesignStatus, design};
use calibrant::error::Complaint;
use calibrant::io::{
    CriterionLetter, EarlierCalibration, Experiment, Prior, design_json, read_calibration, write_atomically,
    write_dense_motion, write_design, write_motion,
};
use calibrant::report::{About, design_report, number};
use std::path::{Path, PathBuf};

/// Find the motion whose recording will determine the parameters best, and prove how close to the best possible it is.
///
/// Writes design.json, motion.csv (what `simulate` and `calibrate` take as --motion) and report.html into DIR. With --evaluate, evaluation.json and evaluation.html too; with
/// --sweep, sweep.json, sweep.csv and report.html instead.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file, with a [motion] (see `calibrant init`).
    experiment: PathBuf,
    /// An earlier calibration.json of this sensor: the design begins at its estimate, and what it knows counts. Several add up; the last gives the values.
    #[arg(long, value_name = "JSON")]
    from: Vec<PathBuf>,
    /// Write motion_dense.csv too: position, velocity, acceleration and jerk at this rate.
    #[arg(long, value_name = "HZ", value_parser = rate, conflicts_with = "sweep")]
    sample_rate: Option<f64>,
    /// Is this motion any good? What it tells, beside the best one, and which limits it breaks.
    #[arg(long, value_name = "CSV", conflicts_with = "sweep")]
    evaluate: Option<PathBuf>,
    /// What can be had as one thing changes: duration=5,10,20, or FROM:TO:COUNT (geometric; FROM:TO:COUNT:linear); also acceleration, jerk, intercept,
    /// velocity, displacement, rate, noise.
    #[arg(long, value_name = "NAME=VALUES", value_parser = sweep::parse)]
    sweep: Option<sweep::Request>,
    /// What is minimised: A, D, E, M, c or I (default: the one in [design]).
    #[arg(long, value_name = "LETTER", value_parser = letter)]
    criterion: Option<CriterionLetter>,
    /// Number of starts (default: the one in [design]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    starts: Option<u32>,
    /// Seed of the random starts (default: the one in [design]).
    #[arg(long, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Do without the bound that no admissible motion can beat; it takes most of the time.
    #[arg(long)]
    no_certificate: bool,
    /// Print design.json on stdout in place of the tables.
    #[arg(long)]
    json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

fn letter(text: &str) -> Result<CriterionLetter, String> {
    CriterionLetter::ALL
        .into_iter()
        .find(|letter| letter.name().eq_ignore_ascii_case(text))
        .ok_or_else(|| "one of A, D, E, M, c, I".into())
}

fn rate(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0).ok_or("a number above 0".into())
}

/// What the experiment file and the options ask for.
struct Job {
    experiment: Experiment,
    earlier: Vec<EarlierCalibration>,
    settings: DesignSettings,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    place::check_directory(&arguments.output)?;
    let job = Job::prepare(arguments)?;
    let problem = job.problem(&arguments.experiment)?;
    match (&arguments.evaluate, &arguments.sweep) {
        (Some(path), _) => evaluate::run(arguments, &job, &problem, path),
        (None, Some(request)) => sweep::run(arguments, &job, &problem, request),
        (None, None) => run_design(arguments, &job, &problem),
    }
}

impl Job {
    fn prepare(arguments: &Arguments) -> calibrant::Result<Self> {
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
            seed: arguments.seed.unwrap_or(otherwise.seed),
            certificate: otherwise.certificate && !arguments.no_certificate,
            ..otherwise
        };
        Ok(Self { experiment, earlier, settings })
    }

    fn problem(&self, file: &Path) -> calibrant::Result<DesignProblem<'_>> {
        self.experiment.design_problem(&self.earlier).map_err(|error| in_file(error, file))
    }

    /// What the report says beside the design.
    fn about(&self, arguments: &Arguments, problem: &DesignProblem<'_>, title: String) -> About {
        let fact = |label: &str, text: String| (label.to_owned(), text);
        let mut facts = vec![
            fact("Experiment", arguments.experiment.display().to_string()),
            fact(
                "Motion",
                format!(
                    "{} of {} s, {} Hz, trust {}",
                    number::counted(problem.intervals, "interval"),
                    number::short(problem.interval_s),
                    number::short(problem.rate_hz),
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

    /// Solves the problem, with a progress bar over its starts.
    fn design(&self, problem: &DesignProblem<'_>) -> calibrant::Result<Design> {
        let bar = console::progress((self.settings.starts * problem.sensor.axes) as u64, "starts");
        let outcome = design(problem, &self.settings, &|done| bar.inc(done));
        bar.finish_and_clear();
        outcome
    }
}

/// Calibrations whose information adds up should be of one sensor, and not the same one twice.
fn warn_of_strangers(earlier: &[EarlierCalibration]) {
    let name = |calibration: &EarlierCalibration| {
        calibration.file.as_ref().map_or_else(String::new, |file| file.display().to_string())
    };
    for (number, calibration) in earlier.iter().enumerate() {
        let same = |other: &&EarlierCalibration| {
            other.values == calibration.values && other.covariance == calibration.covariance
        };
        if let Some(other) = earlier[..number].iter().find(same) {
            console::warn(&format!(
                "{} and {} say the same to the last digit; if they are of one recording, what it knows counts twice: name it once",
                name(other),
                name(calibration)
            ));
        }
    }
    let Some((last, others)) = earlier.split_last() else { return };
    for other in others {
        let degrees_of_freedom = last.values.len() as f64;
        // far beyond chance: mean and variance of χ² are k and 2k
        let most = degrees_of_freedom + 6.0 * (2.0 * degrees_of_freedom).sqrt();
        if let Some(chi2) = last.chi2_against(other).filter(|chi2| *chi2 > most) {
            console::warn(&format!(
                "{} and {} disagree beyond their uncertainty (χ² {} for {degrees_of_freedom} parameters): are they of the same sensor?",
                name(other),
                name(last),
                number::significant(chi2, 3)
            ));
        }
    }
}

/// Names the experiment file in an error about its limits, or about a key of it.
fn in_file(error: Error, file: &Path) -> Error {
    let named = |complaint: Box<Complaint>| {
        if complaint.file.is_none() { Box::new(complaint.in_file(file)) } else { complaint }
    };
    match error {
        Error::Experiment(complaint) if complaint.key.is_some() => Error::Experiment(named(complaint)),
        Error::Infeasible(complaint) => Error::Infeasible(named(complaint)),
        other => other,
    }
}

fn run_design(arguments: &Arguments, job: &Job, problem: &DesignProblem<'_>) -> calibrant::Result<Exit> {
    let design = job.design(problem).map_err(|error| in_file(error, &arguments.experiment))?;
    write(arguments, job, problem, &design)?;
    if arguments.json {
        console::print(&design_json(&design, problem, &job.settings));
    } else {
        console::print(&table::design(&design));
        let output = &arguments.output;
        console::print(&format!(
            "\n{}\n{}\n",
            output.join("motion.csv").display(),
            output.join("report.html").display()
        ));
    }
    Ok(exit_of(&design))
}

/// Writes everything that a design leaves.
fn write(
    arguments: &Arguments,
    job: &Job,
    problem: &DesignProblem<'_>,
    design: &Design,
) -> calibrant::Result<()> {
    let (output, axes) = (&arguments.output, problem.sensor.axes);
    // first what may be refused
    if let Some(rate_hz) = arguments.sample_rate {
        write_dense_motion(&output.join("motion_dense.csv"), &design.optimal.motion, axes, rate_hz)?;
    }
    write_design(&output.join("design.json"), design, problem, &job.settings)?;
    write_motion(&output.join("motion.csv"), &design.optimal.motion, axes)?;
    let about = job.about(arguments, problem, "Design of a motion".into());
    let html = design_report(design, &about);
    write_atomically(&output.join("report.html"), |out| out.write_all(html.as_bytes()))
}

/// The exit status of a design, with what is to be said of it.
fn exit_of(design: &Design) -> Exit {
    if design.status != DesignStatus::Converged && design.optimal.covariance.is_some() {
        console::warn(&format!(
            "the search ended as \"{}\": the motion is admissible, but a better one may be near (raise --starts, or loosen what is very tight)",
            design.status.name()
        ));
    }
    for group in &design.optimal.undetermined {
        console::warn(&format!(
            "the motion leaves {} undetermined: {} ({})",
            group.parameters.join(", "),
            group.reason,
            group.remedy
        ));
    }
    if design.status == DesignStatus::Converged && design.optimal.covariance.is_some() {
        Exit::DONE
    } else {
        Exit::NOT_IDENTIFIABLE
    }
}
