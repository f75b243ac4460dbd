//! The arguments of `calibrant design`.

use super::sweep_request as sweep;
use calibrant::io::CriterionLetter;
use std::path::PathBuf;

/// Find the motion whose recording will determine the parameters best, and prove how close to the best possible it is.
///
/// Writes design.json, motion.csv (what `simulate` and `calibrate` take as --motion) and report.html into DIR. With --evaluate, evaluation.json and evaluation.html too; with
/// --sweep, sweep.json, sweep.csv and report.html instead.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file, with a [motion] (see `calibrant init`).
    pub(super) experiment: PathBuf,
    /// An earlier calibration.json of this sensor: the design begins at its estimate, and what it knows counts. Several add up; the last gives the values.
    #[arg(long, value_name = "JSON")]
    pub(super) from: Vec<PathBuf>,
    /// Write motion_dense.csv too: position, velocity, acceleration and jerk at this rate.
    #[arg(long, value_name = "HZ", value_parser = rate, conflicts_with = "sweep")]
    pub(super) sample_rate: Option<f64>,
    /// Is this motion any good? What it tells, beside the best one, and which limits it breaks.
    #[arg(long, value_name = "CSV", conflicts_with = "sweep")]
    pub(super) evaluate: Option<PathBuf>,
    /// What can be had as one thing changes: duration=5,10,20, or FROM:TO:COUNT (geometric; FROM:TO:COUNT:linear); also acceleration, jerk, intercept,
    /// velocity, displacement, rate, noise.
    #[arg(long, value_name = "NAME=VALUES", value_parser = sweep::parse)]
    pub(super) sweep: Option<sweep::Request>,
    /// What is minimised: A, D, E, M, c or I (default: the one in [design]).
    #[arg(long, value_name = "LETTER", value_parser = letter)]
    pub(super) criterion: Option<CriterionLetter>,
    /// Number of starts (default: the one in [design]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) starts: Option<u32>,
    /// Seed of the random starts (default: the one in [design]).
    #[arg(long, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,
    /// Do without the bound that no admissible motion can beat; it takes most of the time.
    #[arg(long)]
    pub(super) no_certificate: bool,
    /// Print design.json on stdout in place of the tables.
    #[arg(long)]
    pub(super) json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
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
