//! Many recordings of one experiment in one call. Each is calibrated by itself, and none stops the others.
//!
//! A [`Batch`] has the recordings and what they share. [`Batch::run`] calibrates several at the same time and gives one [`BatchRow`] for each: its result, or
//! the error. With a directory each result is written into a folder of its own, and a later run can take it over. Two recordings with the same bytes are not
//! calibrated, since nobody knows which sensor they are of; a fleet whose recordings are spread over several batches finds such [`Copies`] at the end.
//!
//! # Examples
//! Two sensors of a production line, and a file that is not there:
//! ```
//! use calibrant::sensor::SensorKind;
//! use calibrant::batch::{Batch, BatchOptions};
//! use calibrant::io::{Experiment, preset, write_recording};
//! use calibrant::progress::Progress;
//! use calibrant::{Session, SimulationOptions, Source, simulate};
//!
//! let directory = tempfile::tempdir().expect("a directory");
//! let experiment = Experiment::parse(preset("static-poses").expect("built in"), None)?;
//! let mut sources = vec![Source::from_file("missing.csv")];
//! for seed in [1, 2] {
//!     let path = directory.path().join(format!("sensor-{seed}.csv"));
//!     let options = SimulationOptions { seed: Some(seed), ..SimulationOptions::default() };
//!     write_recording(&path, simulate(&experiment, &options)?.recording[SensorKind::Accelerometer].as_ref().expect("there"))?;
//!     sources.push(Source::from_file(path));
//! }
//! let options = BatchOptions { directory: Some(directory.path().join("results")), ..BatchOptions::default() };
//! let batch = Batch::new(Session::new(experiment)?, sources, options)?;
//! let results = batch.run(&Progress::default());
//! assert!(results.rows[0].outcome.is_err() && results.rows[1].outcome.is_ok() && results.rows[2].outcome.is_ok());
//! assert!(directory.path().join("results/sensor-2/calibration.json").exists());
//! # Ok::<(), calibrant::Error>(())
//! ```

mod checks;
mod copies;
mod folders;
mod names;
mod options;
mod page;
mod parallel;
mod quality;
mod record_keeper;
mod result;
mod run;

pub use copies::Copies;
pub use folders::{folder_names, own_names};
pub use options::BatchOptions;
pub use parallel::in_parallel;
pub use result::{BatchResult, BatchResults, BatchRow, RESULT_FILES};
pub use run::Batch;
