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
//! | from a recording's file to the calibration and its report | [`session::Session`], [`session::Outcome`] |
//! | may a result be used; which limits does it keep | [`diagnostic::Verdict`], [`acceptance::CheckedLimit`] |
//! | many calibrations over the years | [`records::Record`], [`records::Aging`], [`records::Distribution`] |
//! | a population of simulated sensors | [`study::Study`], [`study::DesignStudy`] |
//!
//! # From files
//! A sensor that a robot moved, and the commanded motion, as on the command line:
//! ```
//! use calibrant::io::Experiment;
//! use calibrant::session::{Session, SessionOptions, Source};
//!
//! let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/04_many_sensors");
//! let text = std::fs::read_to_string(format!("{folder}/experiment.toml")).expect("it is there");
//! let experiment = Experiment::parse(&text, None)?;
//! let options = SessionOptions { motion: Some(format!("{folder}/motion.csv").into()), ..SessionOptions::default() };
//! let outcome = Session::with(experiment.clone(), options)?.calibrate(&Source::from_file(format!("{folder}/sensor-17.csv")))?;
//!
//! let calibration = outcome.calibration().expect("of a motion");
//! for (parameter, (value, sd)) in calibration.parameters.iter().zip(calibration.values.iter().zip(calibration.sd().iter())) {
//!     println!("{} {value} ± {sd} {}", parameter.name, parameter.unit);
//! }
//! println!("{}", outcome.verdict());
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! # A design
//! The best ten seconds on a linear stage, and how far from the best possible they are:
//! ```
//! use calibrant::design::{DesignProblem, DesignSettings, design};
//! use calibrant::motion::{Limits, Rest};
//! use calibrant::nalgebra::Vector3;
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
//! println!("{}", best.statement());
//! assert!(best.optimal.sd()[1] < 1e-4, "the scale factor to 100 ppm");
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! # Without files
//! Simulate a sensor of the report on a random motion and calibrate it:
//! ```
//! use calibrant::estimate::{CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
//! use calibrant::motion::{CommandedMotion, KnownEnds, Limits, Trust};
//! use calibrant::sensor::Sensor;
//! use calibrant::simulate::{Purpose, draw_sensor, initial_motion, sample_times, simulate_recording, stream};
//!
//! let sensor = Sensor::memsic_mxd2020u();
//! let motion = initial_motion(10, 1.0, 3, &Limits::default(), &mut stream(1, Purpose::Motion, 0))?;
//! let mut rng = stream(1, Purpose::Sensor, 0);
//! let truth = draw_sensor(&sensor, &mut rng);
//! let noise = sensor.noise_mps2.unwrap();
//! let times = sample_times(&motion, 10.0);
//! let recording = simulate_recording(&truth, &noise, sensor.unit, 3, &motion, &times, &mut rng);
//!
//! let command = CommandedMotion { motion, trust: Trust::Known, known_ends: KnownEnds::Start, gravity: None };
//! let problem = CalibrationProblem { sensor: &sensor, recording: &recording, stimulus: Stimulus::Motion(&command) };
//! let calibration = calibrate(&problem, &CalibrationSettings::default())?;
//! let error = calibration.values[0] - truth.bias.x;
//! assert!(error.abs() < 4.0 * calibration.sd()[0], "the bias is within four standard deviations");
//! # Ok::<(), calibrant::Error>(())
//! ```
//!
//! # The modules
//! Data flow one way: [`sensor`] and [`motion`] say what is measured; [`arrowhead`] is the one linear-algebra kernel; [`information`] turns
//! its result into covariance and into words about what is undetermined; [`noise`] examines a sensor at rest; [`estimate`] calibrates; what a user should know of a result is a [`diagnostic`]; [`acceptance`] compares it with limits; [`design`] finds the motion; [`simulate`] makes sensors and recordings;
//! [`study`] compares truth and estimate over many. [`io`] and [`report`] may use all of these, and none uses them.
//! [`session`] stands above all: it reads a recording, calibrates, validates and writes.

pub mod session;

pub use calibrant_core::{
    Error, Result, acceptance, arrowhead, budget, diagnostic, error, estimate, information, motion, noise,
    sensor, simulate,
};
pub use calibrant_design as design;
pub use calibrant_io as io;
pub use calibrant_machine as machine;
#[cfg(feature = "records")]
pub use calibrant_records as records;
pub use calibrant_report as report;
#[cfg(feature = "study")]
pub use calibrant_study as study;
/// The linear algebra in the signatures: vectors and matrices.
pub use nalgebra;
