//! The arguments of `calibrant calibrate`.

use crate::diagnostics::Rules;
use crate::output_places;
use crate::recording_options::RecordingOptions;
use std::ffi::OsStr;
use std::path::PathBuf;

/// Calibrate sensors from their recordings.
///
/// Writes calibration.json and report.html into DIR; with several recordings into a subfolder of DIR for each, named after its file, and
/// DIR/summary.csv. One bad recording does not stop the others; the exit status is then the highest of all.
/// Warnings have codes: --deny CODE makes the exit status 1, --allow CODE silences one.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (see `calibrant init`).
    pub(super) experiment: PathBuf,
    /// Recordings: CSV with header t_s,ax,ay,az, text with columns t x y z, or any file that `calibrant inspect` reads.
    #[arg(required = true)]
    pub(super) recordings: Vec<PathBuf>,
    /// The commanded motion (nodes: t_s,ax_mps2,ay_mps2,az_mps2); a [holds] experiment needs none.
    #[arg(long, value_name = "CSV")]
    pub(super) motion: Option<PathBuf>,
    /// The gyroscope's file, where an IMU's sensors have a file each (imu_tk); with several recordings once for each, in their order.
    #[arg(long, value_name = "FILE")]
    pub(super) gyroscope: Vec<PathBuf>,
    /// List of the sections of a Ferraris session (JSON, as imucal writes it): faces and turns.
    #[arg(long, value_name = "JSON")]
    pub(super) sections: Option<PathBuf>,
    /// Another recording of the sensor, to see whether the covariance is to be believed: errors on its holds and rotations beside what was predicted of them.
    #[arg(long, value_name = "FILE")]
    pub(super) validate: Option<PathBuf>,
    /// The gyroscope's file of that recording, where it has one.
    #[arg(long, value_name = "FILE", requires = "validate")]
    pub(super) validate_gyroscope: Option<PathBuf>,
    /// The same without another recording: leave out each of K blocks of the holds in turn, and predict it from the others.
    #[arg(long, value_name = "K")]
    pub(super) folds: Option<usize>,
    #[command(flatten)]
    pub(super) reading: RecordingOptions,
    /// Unit of the readings where the file does not say.
    #[arg(long, value_enum)]
    pub(super) unit: Option<Unit>,
    #[command(flatten)]
    pub(super) rules: Rules,
    /// Write no report.html: where there are many sensors, and time counts.
    #[arg(long)]
    pub(super) no_report: bool,
    /// Print calibration.json on stdout in place of the tables; for several recordings an array with the file of each, and its calibration or its error.
    #[arg(long)]
    pub(super) json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
}

/// Names of the files that are written.
const RESULTS: [&str; 3] = ["calibration.json", "report.html", "summary.csv"];

impl Arguments {
    /// Refuses to write results of these folders of DIR where something was read.
    pub(super) fn check_inputs(&self, folders: &[String]) -> calibrant::Result<()> {
        let others =
            [&self.motion, &self.sections, &self.validate, &self.validate_gyroscope].into_iter().flatten();
        let inputs = self.recordings.iter().chain(&self.gyroscope).chain([&self.experiment]).chain(others);
        for input in inputs {
            let is_taken = |name: &&OsStr| RESULTS.iter().any(|result| *name == *result);
            let Some(name) = input.file_name().filter(is_taken) else { continue };
            for folder in folders {
                output_places::check_not_input(&self.output.join(folder).join(name), &[input])?;
            }
        }
        Ok(())
    }

    /// The file to look at.
    pub(super) fn main_result(&self) -> PathBuf {
        self.output.join(if self.no_report { "calibration.json" } else { "report.html" })
    }
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub(super) enum Unit {
    /// Metres per second squared.
    Mps2,
    /// Raw counts.
    Counts,
}
