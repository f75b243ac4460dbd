//! The arguments of `calibrant design`.

use super::sweep_request as sweep;
use calibrant::GoalRequest;
use calibrant::io::CriterionLetter;
use std::path::PathBuf;

/// Design the motion, or the poses, whose recording determines the parameters best, with a bound that no other can beat.
///
/// With [holds] in the experiment it finds the best poses, and writes design.json, poses.csv and report.html, a checklist to print. --evaluate RECORDING says how
/// efficient recorded holds were. --from calibration.json --add 3 says which poses to record next. [design] says what is known of directions, and which are allowed.
///
/// With [campaign] it finds the best soaks over temperature, and writes design.json, campaign.csv and report.html. --sweep budget=120,240,480 says what time buys.
/// --from calibration.json --add-min 60 says which soaks to add.
///
/// With joints in [machine] it finds the best trajectory of the machine, proves its limits for all times, and writes trajectory.csv, follow_joint_trajectory.yaml (ROS 2),
/// trajectory.script (Universal Robots), design.json and report.html. `simulate` and `calibrate` take trajectory.csv as --motion.
///
/// With [motion] it finds the best motion.
/// Writes design.json, motion.csv and report.html into DIR. `simulate` and `calibrate` take motion.csv as --motion. --evaluate adds evaluation.json and
/// evaluation.html. --sweep writes sweep.json, sweep.csv and report.html instead.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file, with a [motion], [holds] or [machine] (see `calibrant init`).
    pub(super) experiment: PathBuf,
    #[command(flatten)]
    pub(super) settings: crate::experiment_settings::Settings,
    /// An earlier calibration.json of this sensor. The design starts at its estimate, and uses its information. Repeatable: the information adds up, and the last file gives the estimate.
    /// Of a machine it gives geometry, mount, delays and noise.
    #[arg(long, value_name = "JSON")]
    pub(super) from: Vec<PathBuf>,
    /// Also write motion_dense.csv: position, velocity, acceleration and jerk at this rate.
    #[arg(long, value_name = "HZ", value_parser = rate, conflicts_with = "sweep")]
    pub(super) sample_rate: Option<f64>,
    /// Evaluate this motion, this trajectory.csv of a machine, or this recording of holds: its information against that of the best, and the limits that a motion breaks.
    #[arg(long, value_name = "CSV", conflicts_with_all = ["sweep", "reach"])]
    pub(super) evaluate: Option<PathBuf>,
    /// Design for several values of one quantity: duration=5,10,20, or duration=FROM:TO:COUNT (geometric), or FROM:TO:COUNT:linear. Other quantities:
    /// acceleration, jerk, intercept, velocity, displacement, rate, noise. A machine is swept over its duration, a campaign over temperature over its budget, min.
    #[arg(long, value_name = "NAME=VALUES", value_parser = sweep::parse)]
    pub(super) sweep: Option<sweep::Request>,
    /// Find the fewest poses, or the shortest motion, with which a parameter has this standard deviation: scale.x=50ppm, bias.z=0.2mg. Repeatable. It proves a
    /// number below which none can. Of a machine it finds the shortest duration within 6 %, without a proof; scale=50ppm is of every scale factor, gyroscope.bias=1deg/h of
    /// the gyroscope's biases.
    #[arg(long, value_name = "NAME=SD", value_parser = GoalRequest::parse, conflicts_with_all = ["sweep", "evaluate"])]
    pub(super) reach: Vec<GoalRequest>,
    /// Number of poses, in place of holds.poses: those to add to an earlier calibration (--from).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=200), conflicts_with_all = ["sweep", "evaluate", "reach", "add_min"])]
    pub(super) add: Option<u32>,
    /// The time to add to a campaign over temperature that is recorded already (--from), min, ramps included.
    #[arg(long, value_name = "MIN", value_parser = rate, requires = "from", conflicts_with = "sweep")]
    pub(super) add_min: Option<f64>,
    /// Criterion to minimise: A, D, E, M, c or I (default: from [design]).
    #[arg(long, value_name = "LETTER", value_parser = letter)]
    pub(super) criterion: Option<CriterionLetter>,
    /// Number of starts of the search (default: from [design]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) starts: Option<u32>,
    /// Search for this many seconds, in place of a number of starts. The same command may then find another motion.
    #[arg(long, value_name = "S", value_parser = rate, conflicts_with = "sweep")]
    pub(super) seconds: Option<f64>,
    /// Seed of the random starts (default: from [design]).
    #[arg(long, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,
    /// Skip the bound that no admissible motion can beat. It takes most of the time.
    #[arg(long)]
    pub(super) no_certificate: bool,
    /// End the search once the motion is proved to be this close to the bound, such as 1%. For criterion D, 1% is 0.01 nats. The bound is then found first.
    #[arg(long, value_name = "SHARE", value_parser = gap, conflicts_with_all = ["no_certificate", "sweep", "reach"])]
    pub(super) gap: Option<f64>,
    /// On a machine: the same path this many times slower, for the first run. What it then determines is said.
    #[arg(long, value_name = "TIMES", value_parser = slow, conflicts_with_all = ["evaluate", "sweep", "reach"])]
    pub(super) slow: Option<f64>,
    /// Print design.json on stdout instead of the tables.
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

fn slow(text: &str) -> Result<f64, String> {
    rate(text).ok().filter(|times| (1.0..=1000.0).contains(times)).ok_or("a number from 1 to 1000".into())
}

/// Reads `1%` or `0.01`.
fn gap(text: &str) -> Result<f64, String> {
    let (number, size) = match text.trim().strip_suffix('%') {
        Some(percent) => (percent, 0.01),
        None => (text, 1.0),
    };
    let gap = number.trim().parse::<f64>().ok().map(|number| number * size).filter(|gap| gap.is_finite());
    match gap {
        Some(gap) if gap > 0.0 && gap < 1.0 => Ok(gap),
        Some(gap) if gap >= 1.0 => Err(format!(
            "{text} is a gap of {} %, which says nothing: ask for less than 100 %, such as 1%",
            100.0 * gap
        )),
        _ => Err("a share above 0, such as 1% or 0.01".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::gap;

    #[test]
    fn a_gap_is_a_share_or_in_percent() {
        assert_eq!((gap("1%"), gap("0.01"), gap(" 2.5 %")), (Ok(0.01), Ok(0.01), Ok(0.025)));
        for nonsense in ["0", "-1%", "1", "100%", "nan", "inf", "%", "one"] {
            assert!(gap(nonsense).is_err(), "{nonsense}");
        }
        assert!(gap("5").is_err_and(|error| error.contains("500 %")));
    }
}
