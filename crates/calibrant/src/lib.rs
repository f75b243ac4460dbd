//! calibrant calibrates inertial sensors from a recording, says how well, and says when it cannot; and it finds the best motion to record.
//!
//! # The problem
//! A sensor reports `y = S s + b + ν`, `ν ~ N(0, Σ_ν)`, of a stimulus `s` (true → raw). Calibrating it means estimating the parameters
//! `p = (b, S)` and their covariance from readings of a motion that is trusted more or less:
//!
//! ```text
//! minimise over p, a:  ½ Σ_k ‖y_k − S α(t_k; a) − b‖²_{Σ_ν⁻¹}  +  ½ Σ_i ‖(a_{i+1} − a_i)/Δτ − u_i‖²_{Σ_{w,i}⁻¹}
//! ```
//!
//! `α(t; a)` is the acceleration, linear between nodes `a_i`; `u_i` the commanded jerk. Whether the motion is known (`Σ_w = 0`), noisy or
//! unknown (`Σ_w = ∞`, only the ends known) is one setting, [`motion::Trust`]. Where there is no robot, the sensor is held still in several
//! orientations: `|s| = g`, directions unknown ([`estimate::HoldsSetup`]).
//!
//! # The second problem
//! Which motion to record? With `Σ_p` the covariance that the first problem will give and `Φ` one of the [criteria](information::criterion),
//!
//! ```text
//! minimise over a:  Φ(Σ_p(a, p̄))   subject to the arm's limits, at all times
//! ```
//!
//! # The types
//!
//! | what | type |
//! |---|---|
//! | the datasheet: model, unit, noise, spread | [`sensor::Sensor`] |
//! | the parameters, their names and units | [`sensor::ParameterList`], [`sensor::SensorParameters`] |
//! | readings over time | [`sensor::Recording`] |
//! | a commanded motion and the trust in it | [`motion::CommandedMotion`], [`motion::JerkControlledMotion`] |
//! | the problem, and how to solve it | [`estimate::CalibrationProblem`], [`estimate::CalibrationSettings`] |
//! | estimates, covariance, fit, recovered motion or holds, and what a gyroscope adds | [`estimate::Calibration`] |
//! | an IMU calibrated here or elsewhere, its correction, two of them compared | [`sensor::CalibratedImu`], [`sensor::ImuCorrection`], [`estimate::Comparison`] |
//! | the motion to find, and how | [`design::DesignProblem`], [`design::DesignSettings`] |
//! | the best motion, what it promises, and the proof | [`design::Design`], [`design::Certificate`] |
//! | a motion of one's own beside it; the best as one thing changes | [`design::Assessment`], [`design::Sweep`] |
//! | the noise of a sensor at rest, its Allan deviation | [`noise::SensorNoise`], [`noise::AllanDeviation`] |
//! | from a recording, in a file or in memory, to the calibration and its report | [`Session`], [`Outcome`] |
//! | many recordings of one experiment, one row for each | [`batch::Batch`] |
//! | a sensor on a machine: the chain of its joints, the log of the motion, the result | [`machine::chain::KinematicChain`], [`machine::log::ReferenceLog`], [`machine::estimate::MachineCalibration`] |
//! | may a result be used; which limits does it keep | [`diagnostic::Verdict`], [`acceptance::CheckedLimit`] |
//! | many calibrations over the years | [`records::Record`], [`records::Aging`], [`records::Distribution`] |
//! | a population of simulated sensors | [`study::Study`], [`study::DesignStudy`] |
//!
//! # Five programs
//! A CSV. The experiment says what is known of the sensor and of what was done with it; it is the text of a file, or one of the [presets](io::PRESETS):
//! ```
//! use calibrant::sensor::SensorKind;
//! use calibrant::io::{Experiment, write_recording, preset};
//! use calibrant::{Session, Source};
//!
//! # let folder = tempfile::tempdir().expect("a folder");
//! # let (path, results) = (folder.path().join("recording.csv"), folder.path());
//! let experiment = Experiment::parse(preset("static-poses").expect("built in"), None)?;
//! # let simulated = calibrant::simulate(&experiment, &calibrant::SimulationOptions::default())?;
//! # write_recording(&path, simulated.recording[SensorKind::Accelerometer].as_ref().expect("there"))?;
//! let outcome = Session::new(experiment)?.calibrate(&Source::from_file(&path))?;
//! let calibration = outcome.calibration();
//! for (parameter, (value, sd)) in calibration.parameters.iter().zip(calibration.values.iter().zip(calibration.sd().iter())) {
//!     println!("{} {value} ± {sd} {}", parameter.name, parameter.unit);
//! }
//! println!("{}", outcome.verdict());
//! outcome.write(results)?; // calibration.json and report.html
//! # assert!(results.join("report.html").exists());
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! Arrays: columns named as those of a CSV. The same units, findings and questions follow from them:
//! ```
//! use calibrant::sensor::SensorKind;
//! use calibrant::io::{Experiment, preset};
//! use calibrant::{Session, Source};
//!
//! let experiment = Experiment::parse(preset("imu").expect("built in"), None)?;
//! # let recording = calibrant::simulate(&experiment, &calibrant::SimulationOptions::default())?.recording;
//! # let (force, rate) = (recording.sensor(SensorKind::Accelerometer).expect("there"), recording.sensor(SensorKind::Gyroscope).expect("there"));
//! # let t = force.times_s().to_vec();
//! # let column = |of: &calibrant::sensor::Recording, axis: usize| -> Vec<f64> { of.readings().iter().map(|y| y[axis]).collect() };
//! # let [fx, fy, fz] = [0, 1, 2].map(|axis| column(&force, axis));
//! # let [wx, wy, wz] = [0, 1, 2].map(|axis| column(&rate, axis));
//! let table: [(&str, &[f64]); 7] = [
//!     ("t_s", &t), ("ax_mps2", &fx), ("ay_mps2", &fy), ("az_mps2", &fz), ("gx_radps", &wx), ("gy_radps", &wy), ("gz_radps", &wz),
//! ];
//! let outcome = Session::new(experiment)?.calibrate(&Source::from_columns("bench", &table))?;
//! let imu = outcome.calibration().calibrated();
//! println!("{} {}", imu.parameters[SensorKind::Gyroscope].matrix, outcome.verdict());
//! # assert_eq!(imu.covariance.map(|of| of.nrows()), Some(imu.quantities.len()));
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! A motion: the best ten seconds on a linear stage, and how far from the best possible they are:
//! ```
//! use calibrant::design::{DesignProblem, DesignSettings, design};
//! use calibrant::motion::{Limits, Rest};
//! use calibrant::nalgebra::Vector3;
//! use calibrant::report::{About, design_sheet};
//! use calibrant::sensor::Sensor;
//!
//! let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
//! let limits = Limits {
//!     acceleration_mps2: Some(Vector3::repeat(2.0)),
//!     jerk_mps3: Some(Vector3::repeat(20.0)),
//!     velocity_mps: Some(Vector3::repeat(0.5)),
//!     displacement_m: Some(Vector3::repeat(0.3)),
//!     rest: Rest::Both,
//!     ..Limits::default()
//! };
//! let best = design(&DesignProblem::new(&sensor, &limits, 10.0)?, &DesignSettings::default(), &|_| {})?;
//! println!("{}", design_sheet(&best, &About::default()).text(80));
//! # assert!(best.optimal.sd()[1] < 1e-4, "the scale factor to 100 ppm");
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! A machine, with arrays: times and readings of the sensor, times and positions of the joints:
//! ```
//! use calibrant::io::{Experiment, preset};
//! use calibrant::machine::log::{JointLog, ReferenceLog};
//! use calibrant::session::MotionSource;
//! use calibrant::{Session, SessionOptions, Source};
//!
//! let experiment = Experiment::parse(preset("gantry").expect("built in"), None)?;
//! # let mut short = experiment.clone();
//! # if let calibrant::io::Plan::Machine(plan) = &mut short.plan { plan.simulation.duration_s = 10.0; }
//! # let simulated = calibrant::simulate(&short, &calibrant::SimulationOptions::default())?;
//! # let Some((ReferenceLog::Joints(JointLog { times_s, positions, .. }), _)) = simulated.log else { unreachable!() };
//! # let recording = simulated.recording;
//! // positions: x, y, z of the first time, then of the second, …
//! let names = ["x", "y", "z"].map(str::to_owned).to_vec();
//! let log = ReferenceLog::Joints(JointLog { names, times_s, positions, velocities: None });
//! let options = SessionOptions { motion: Some(MotionSource::Logged(log)), ..SessionOptions::default() };
//! let outcome = Session::with(experiment, options)?.calibrate(&Source::from_recording("gantry", recording))?;
//! println!("{}", outcome.sheet().text(80));
//! # assert!(outcome.calibrated.machine().is_some(), "it is a calibration on a machine");
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! A calibration that is there, applied to arrays:
//! ```
//! use calibrant::nalgebra::Vector3;
//! use calibrant::sensor::{ImuCorrection, ImuRecording, ReadingUnit, Recording, SensorKind};
//!
//! # let mut parameters = calibrant::sensor::ImuParameters::identity();
//! # parameters[SensorKind::Accelerometer].bias.x = 0.1;
//! # let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
//! # let imu = calibrant::sensor::CalibratedImu::new(parameters, units, vec![], "");
//! # let (t, y) = (vec![0.0, 0.01], vec![Vector3::new(0.3, 0.0, 9.8); 2]);
//! // imu: io::read_calibrated_imu reads it from a file of any program
//! let recording = ImuRecording::from(Recording::new(t, y, 3, ReadingUnit::MetrePerSecondSquared)?);
//! let corrected = ImuCorrection::of(&imu)?.apply(&recording)?.accelerometer.expect("there");
//! println!("{:?} {:?}", corrected.values, corrected.sd);
//! # assert!((corrected.values[0].x - 0.2).abs() < 1e-12);
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! # The modules
//! Data flow one way: [`sensor`] and [`motion`] say what is measured; [`arrowhead`] is the one linear-algebra kernel; [`information`] turns
//! its result into covariance and into words about what is undetermined; [`noise`](mod@noise) examines a sensor at rest; [`estimate`] calibrates; [`machine`] does
//! so for a sensor on a machine, whose joints or poses are logged; what a user should know of a result is a [`diagnostic`]; [`acceptance`] compares it with
//! limits; [`design`] finds the motion; [`simulate`](mod@simulate) makes sensors and recordings; [`study`] compares truth and estimate over many.
//! [`io`] and [`report`] may use all of these, and none uses them. [`session`] stands above all: it reads a recording, calibrates, validates and writes.
//!
//! What a command does beside that is a function: [`simulate()`], [`noise()`], [`apply`], [`DesignPlan`], [`StudyPlan`]. [`interruption`] and [`progress`]
//! reach every task that takes long.

pub mod batch;
mod campaign_calibration;
mod campaign_ramps;
mod campaign_rehearsal;
mod campaign_soaks;
mod conversion;
mod correction;
mod design_plan;
mod design_remarks;
mod goal_request;
pub mod inspection;
mod json_files;
mod noise_at_rest;
mod reached;
#[cfg(feature = "study")]
mod rehearsal;
pub mod session;
mod simulation;
#[cfg(feature = "study")]
mod study_plan;
mod trajectory_plan;

pub use calibrant_campaign as campaign;
pub use calibrant_core::{
    Error, Result, acceptance, arrowhead, budget, diagnostic, error, estimate, information, interruption,
    motion, noise, progress, sensor, simulate,
};
pub use calibrant_design as design;
pub use calibrant_io as io;
pub use calibrant_machine as machine;
pub use calibrant_machine_design as machine_design;
#[cfg(feature = "records")]
pub use calibrant_records as records;
pub use calibrant_report as report;
#[cfg(feature = "study")]
pub use calibrant_study as study;
pub use campaign_calibration::CampaignCalibration;
pub use campaign_ramps::{calibrate_soaks, is_ramp};
pub use campaign_rehearsal::CampaignStudy;
pub use conversion::Conversion;
pub use correction::{Applied, apply, read_for_correction};
pub use design_plan::{DesignChoice, DesignPlan, RecordedPoses};
pub use design_remarks::{rest_remark, sweep_remarks, undetermined_by};
pub use goal_request::GoalRequest;
pub use json_files::{FileKind, json_page};
/// The linear algebra in the signatures: vectors and matrices.
pub use nalgebra;
pub use noise_at_rest::{NoiseAtRest, NoiseOptions, noise, read_for_noise};
pub use reached::ReachedDesign;
#[cfg(feature = "study")]
pub use rehearsal::RehearsalPlan;
pub use session::{Outcome, Readings, Session, SessionOptions, Source};
pub use simulation::{
    SimulatedCampaign, Simulation, SimulationOptions, commanded_motion, simulate, simulate_campaign,
};
#[cfg(feature = "study")]
pub use study_plan::{StudyChoice, StudyPlan};
pub use trajectory_plan::TrajectoryPlan;
