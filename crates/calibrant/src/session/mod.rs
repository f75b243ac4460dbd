//! From a recording, in a file or in memory, to a calibration and its report, in one call.
//!
//! | stage | what it does | where |
//! |---|---|---|
//! | read | reads the files of a [`Source`] | `reader`, `recorded` |
//! | clean | takes spikes and invalid readings out | `clean` |
//! | holds | finds the stationary intervals | `holds` |
//! | noise | examines the longest hold of an IMU | `noise` |
//! | calibrate | estimates the parameters and their covariance | [`estimate`](crate::estimate) |
//! | validate | tries the calibration on data that it is not from | `validation` |
//! | judge | checks the limits of `[accept]` and makes the verdict | `acceptance`, `figures` |
//! | report | writes `calibration.json` and `report.html` | `outcome`, `report` |
//!
//! Each stage runs once and hands its result on. The stages in their order are in `task`.
//!
//! # Examples
//! A simulated accelerometer that is held still in 24 orientations:
//! ```
//! use calibrant::io::{Experiment, preset, write_recording};
//! use calibrant::session::{Session, Source};
//! use calibrant::sensor::{ReadingUnit, SensorKind, SensorParameters};
//! use calibrant::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};
//! use nalgebra::Vector3;
//!
//! let directory = tempfile::tempdir().expect("a directory");
//! let simulation = HoldsSimulation { poses: 24, hold_s: 3.0, turn_s: 1.5, rate_hz: 100.0, gravity_mps2: 9.806_65, between_holds_sd_mps2: 0.0 };
//! let (truth, noise) = (SensorParameters::identity(), Vector3::repeat(0.01));
//! let mut rng = stream(1, Purpose::Sensor, 0);
//! let (recording, _) = simulate_holds(&truth, &noise, ReadingUnit::MetrePerSecondSquared, &simulation, &mut rng);
//! let file = directory.path().join("recording.csv");
//! write_recording(&file, &recording)?;
//!
//! let experiment = Experiment::parse(preset("static-poses").expect("it exists"), None)?;
//! let session = Session::new(experiment)?;
//! let outcome = session.calibrate(&Source::from_file(&file))?;
//! outcome.write(directory.path())?;
//!
//! let calibration = outcome.calibration();
//! assert!(calibration.imu[SensorKind::Accelerometer].bias.norm() < 0.01);
//! assert!(directory.path().join("report.html").exists());
//! # Ok::<(), calibrant::Error>(())
//! ```

mod acceptance;
mod calibrated;
mod clean;
mod duplicates;
mod failure;
mod figures;
mod head;
mod held_out;
mod holds;
mod kind;
mod left_out;
mod machine;
mod machine_datasheet;
mod machine_limits;
mod machine_log;
mod motion_source;
mod noise;
mod one_pose;
mod options;
mod other_soaks;
mod outcome;
mod prepared;
mod problem;
mod read_imu;
mod reader;
mod recorded;
mod report;
mod residuals;
mod run;
mod sections;
mod setup;
mod source;
mod task;
mod unused;
mod validation;

pub(crate) use acceptance::doubts;
pub use calibrated::{Calibrated, MachineOutcome};
pub use motion_source::MotionSource;
pub use options::SessionOptions;
pub use other_soaks::OtherSoaks;
pub use outcome::Outcome;
pub use residuals::{ResidualSeries, Residuals};
pub use run::Session;
pub use source::{Readings, SectionList, Source};
pub use unused::Given;
