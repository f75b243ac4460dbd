//! The arguments of `calibrant calibrate`.

use super::naming::Naming;
use crate::recording_options::RecordingOptions;
use std::path::PathBuf;
use std::sync::Mutex;

/// Calibrate sensors from their recordings.
///
/// Writes calibration.json and report.html into DIR. Several recordings get a subfolder of DIR each, named after the file (or, where files
/// have equal names, after the part of the path that differs), and one
/// DIR/summary.csv and DIR/batch.html. One bad recording does not stop the others. The exit status is the highest of all.
/// Each result has a verdict: ok, doubtful or bad. The exit status is 5 where one is bad, or breaks a limit of [accept].
/// Each warning has a code: --deny CODE sets the exit status 1, --allow CODE silences the warning.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (see `calibrant init`).
    pub(super) experiment: PathBuf,
    #[command(flatten)]
    pub(super) settings: crate::experiment_settings::Settings,
    /// Recordings: CSV with the header t_s,ax,ay,az, text with columns t x y z, or any file that `calibrant inspect` reads.
    #[arg(required = true)]
    pub(super) recordings: Vec<PathBuf>,
    /// The commanded motion, one row for each node: t_s,ax_mps2,ay_mps2,az_mps2. On a [machine] the log of its joints, or poses. A [holds]
    /// experiment needs none.
    #[arg(long, value_name = "FILE")]
    pub(super) motion: Option<PathBuf>,
    /// The gyroscope's file, if each sensor of the IMU has its own file (imu_tk). Give it once for each recording, in their order.
    #[arg(long, value_name = "FILE")]
    pub(super) gyroscope: Vec<PathBuf>,
    /// Sections of a Ferraris session, faces and turns: JSON, as imucal writes it.
    #[arg(long, value_name = "JSON")]
    pub(super) sections: Option<PathBuf>,
    /// Another recording of the sensor, to validate the covariance. The command compares the errors on its holds and rotations with the predicted errors;
    /// on a machine, the parameters that it gives.
    #[arg(long, value_name = "FILE")]
    pub(super) validate: Option<PathBuf>,
    /// The gyroscope's file of that recording, if there is one.
    #[arg(long, value_name = "FILE", requires = "validate")]
    pub(super) validate_gyroscope: Option<PathBuf>,
    /// The log of the machine's motion in that recording, if it is not in the same file.
    #[arg(long, value_name = "FILE", requires = "validate")]
    pub(super) validate_motion: Option<PathBuf>,
    /// The recordings are of one sensor: fit them together. The result is one calibration.
    #[arg(long)]
    pub(super) together: bool,
    /// Validate without another recording: each of K blocks of holds is predicted from the others. On a machine, each of K blocks of time is left out.
    #[arg(long, value_name = "K")]
    pub(super) folds: Option<usize>,
    #[command(flatten)]
    pub(super) reading: RecordingOptions,
    /// The limits that a result must keep, in place of [accept] of the experiment file. It is a file with this section.
    #[arg(long, value_name = "FILE")]
    pub(super) accept: Option<PathBuf>,
    #[command(flatten)]
    pub(super) naming: Naming,
    /// Add each result to these records, an SQLite database that is made where there is none (see `calibrant records`). A recording that they have of another sensor is refused.
    #[arg(long, value_name = "FILE")]
    pub(super) records: Option<PathBuf>,
    /// Write the residuals to this table, .csv or .parquet: one row for each sample and axis, or for each hold and rotation. It is for one calibration.
    #[arg(long, value_name = "FILE")]
    pub(super) residuals: Option<PathBuf>,
    /// Write no report.html. This saves time with many sensors.
    #[arg(long)]
    pub(super) no_report: bool,
    /// Continue a batch that was interrupted. Results in DIR that are of the same recordings, experiment, options and version are not computed again.
    #[arg(long)]
    pub(super) resume: bool,
    /// Print calibration.json on stdout instead of the tables. Several recordings give an array: the file of each, and its calibration or its error.
    #[arg(long)]
    pub(super) json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
    /// Results of an earlier run that this one has taken over.
    #[arg(skip)]
    pub(super) kept: Mutex<Vec<PathBuf>>,
}

impl Arguments {
    /// The file that the command names at its end.
    pub(super) fn main_result(&self) -> PathBuf {
        self.output.join(self.main_file())
    }

    /// The file of a result that people open first.
    pub(super) fn main_file(&self) -> &'static str {
        if self.no_report { "calibration.json" } else { "report.html" }
    }
}
