//! The arguments of `calibrant simulate`.

use std::path::PathBuf;

/// Simulate a sensor drawn from the datasheet, and its recording.
///
/// Writes recording.csv and truth.json; for a [motion] also motion.csv, the commanded motion that `calibrate --motion` wants, and with process
/// noise true_motion.csv, the one that really happened.
///
/// An IMU (kind = "imu") is turned by hand between holds.poses orientations; with holds.directions it is put down on these faces and turned by gyroscope.turns, at
/// the times that are given. Spreads that [sensor] does not give, and the gyroscope's, are those of common MEMS sensors.
/// With [temperature] it warms by 24 K about the reference from the beginning to the end, and the recording has a column temp_c.
///
/// The seed draws the sensor, --recording N what happens in its Nth recording: the same truth.json, independent noise, other random poses or motion. Number all
/// recordings that are to be independent, those of different experiments too. A validation is rehearsed with two:
///
/// calibrant simulate imu.toml -o one; calibrant simulate imu.toml --recording 2 -o two
///
/// calibrant calibrate imu.toml one/recording.csv --validate two/recording.csv -o result
///
/// calibrant compare one/truth.json result/calibration.json then tells how far the result is from the truth, in its standard deviations.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (see `calibrant init`).
    pub(super) experiment: PathBuf,
    /// The commanded motion (nodes: t_s,ax_mps2,ay_mps2,az_mps2); default: the random initial motion.
    #[arg(long, value_name = "CSV")]
    pub(super) motion: Option<PathBuf>,
    /// Seed of everything random (default: the one in [study], 1).
    #[arg(long, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,
    /// Which recording of the sensor that the seed draws: each has its own noise and its own random poses or motion.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) recording: u32,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
}
