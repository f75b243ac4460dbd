//! The native part of calibrant's Python package: few functions that take and give JSON and arrays. The package above it is in `python/calibrant`.
//!
//! | file | what |
//! |---|---|
//! | `work` | runs every call: threads of its own, signals, panics |
//! | `failure`, `wording` | errors as exceptions, in Python's words |
//! | `options`, `choice`, `arrays`, `page` | what comes and goes |
//! | the others | one for each command |

mod arrays;
mod batch;
mod calibrate;
mod calibration;
mod campaign;
mod choice;
mod design;
mod experiment;
mod explain;
mod failure;
mod inspect;
mod motion;
mod noise;
mod options;
mod over_temperature;
mod page;
mod poses;
mod recording;
mod records;
mod series;
mod simulate;
mod soaks;
mod source;
mod study;
mod sweep;
mod trajectory;
mod wording;
mod work;

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line; the first argument is its name.
#[pyfunction]
fn command_line(arguments: Vec<OsString>) -> u8 {
    calibrant_cli::main(arguments)
}

/// Name and version of the program, as results state it.
#[pyfunction]
fn program() -> String {
    calibrant::io::program()
}

/// The native part of the package `calibrant`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{command_line, program};
    #[pymodule_export]
    use crate::batch::{calibrate_each, hashes, keys, study_each};
    #[pymodule_export]
    use crate::calibrate::{Outcome, calibrate};
    #[pymodule_export]
    use crate::calibration::{Correction, compare, convert_calibration, read_calibration};
    #[pymodule_export]
    use crate::campaign::{CampaignSimulation, design_campaign, simulate_campaign, sweep_campaign};
    #[pymodule_export]
    use crate::design::{assess, design};
    #[pymodule_export]
    use crate::experiment::{Experiment, merged, preset_text, presets, sections_of};
    #[pymodule_export]
    use crate::explain::explained;
    #[pymodule_export]
    use crate::inspect::{inspect_log, inspect_machine, is_log};
    #[pymodule_export]
    use crate::motion::Motion;
    #[pymodule_export]
    use crate::noise::noise;
    #[pymodule_export]
    use crate::poses::{assess_poses, design_poses};
    #[pymodule_export]
    use crate::recording::{Recording, read_recording};
    #[pymodule_export]
    use crate::records::Records;
    #[pymodule_export]
    use crate::simulate::{Simulation, simulate};
    #[pymodule_export]
    use crate::soaks::{calibrate_campaign, calibrate_soaks};
    #[pymodule_export]
    use crate::source::{Readings, Source};
    #[pymodule_export]
    use crate::study::study;
    #[pymodule_export]
    use crate::sweep::sweep;
    #[pymodule_export]
    use crate::trajectory::{Trajectory, assess_trajectory, design_trajectory};
}
