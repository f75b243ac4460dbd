//! The arguments of `calibrant simulate`.

use std::path::PathBuf;

/// Simulate a sensor with parameters from the datasheet spread, and a recording of it.
///
/// Writes recording.csv and truth.json. A [motion] adds motion.csv, the commanded motion for `calibrate --motion`. Process noise adds
/// true_motion.csv, the motion that took place.
///
/// An IMU (kind = "imu") is rotated by hand between holds.poses orientations. With holds.directions it is put on these faces, and makes the gyroscope.turns, at the given
/// times. Spreads that the file does not give are those of common MEMS sensors. With [temperature] the sensor warms by 24 K, centred on the reference, and the recording
/// has a column temp_c.
///
/// A campaign over temperature ([campaign]) gives a recording of each soak, soak_01.csv and so on: of a sensor whose polynomials, hysteresis and lag are drawn from
/// what the file says of them.
///
/// A sensor on a machine ([machine]) adds the log: joints.csv, or poses.csv without a urdf. What the experiment has a standard deviation for is drawn: lever arm,
/// mounting, tilt, delays, clock rate, geometry. Without --motion, the joints go between random way-points within the limits of position and speed in the
/// urdf, and a body is moved as by hand; [machine.simulate] has durations, rates and noise. Noise that the file does not give: 0.01 m/s² and 0.002 rad/s for the
/// sensors, 2e-5 rad or m for joints, 0.2 mm and 1 mrad for poses.
///
/// The seed draws the sensor. --recording N draws its Nth recording: the same truth.json, but independent noise and other random poses or motion. Give each independent
/// recording its own number, also across experiments. Two recordings rehearse a validation:
///
/// calibrant simulate imu.toml -o one; calibrant simulate imu.toml --recording 2 -o two
///
/// calibrant calibrate imu.toml one/recording.csv --validate two/recording.csv -o result
///
/// calibrant compare one/truth.json result/calibration.json then shows the error of the result, in its standard deviations.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (see `calibrant init`).
    pub(super) experiment: PathBuf,
    #[command(flatten)]
    pub(super) settings: crate::experiment_settings::Settings,
    /// The commanded motion, one row for each node: t_s,ax_mps2,ay_mps2,az_mps2 (default: a random motion; a shuttle at the limits, where a random one would say less than the datasheet). On a machine: a log of its joints or poses.
    #[arg(long, value_name = "CSV")]
    pub(super) motion: Option<PathBuf>,
    /// The poses of a sensor that is held by hand, such as those of `design`: columns up_x, up_y, up_z (default: random ones, those of an accelerometer alone spread over the sphere).
    #[arg(long, value_name = "CSV")]
    pub(super) poses: Option<PathBuf>,
    /// The timetable of a campaign over temperature, such as that of `design` (default: the best campaign).
    #[arg(long, value_name = "CSV")]
    pub(super) campaign: Option<PathBuf>,
    /// Seed of all random numbers (default: from [study], else 1).
    #[arg(long, allow_negative_numbers = true)]
    pub(super) seed: Option<u64>,
    /// Number of the recording. Each has its own noise and its own random poses or motion.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) recording: u32,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
}
