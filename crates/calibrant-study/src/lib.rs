//! Studies over many simulated sensors: what a calibration promises beside what it delivers.
//!
//! | experiment | of the thesis | gives |
//! |---|---|---|
//! | [`run_study`]: sensors moved by the same command, truth beside estimate | Figures 4 to 6 | [`Study`] |
//! | [`trace_surface`](calibrant_design::trace_surface): the criterion over the jerks of two intervals | Figure 7 | [`TraceSurface`](calibrant_design::TraceSurface) |
//! | [`run_design_study`]: each sensor calibrated on a random motion, and again on the one designed for it | Figures 8 to 11, 13, 14 | [`DesignStudy`] |
//! | of a machine: each sensor calibrated on a plain routine, and again on the best trajectory | the same, for an arm | [`Rehearsal`] |
//!
//! [`run_studies`] runs the wanted studies, one after the other.

mod all_studies;
mod calibration;
mod design_loop;
mod rehearsal;
mod result;
mod simulated_recording;
mod summary;

pub use all_studies::{Studies, StudiesProblem, run_studies};
pub use calibration::{StudyProblem, StudySettings, run_study};
pub use design_loop::{DesignStudyProblem, run_design_study};
pub use rehearsal::{Departure, Rehearsal, RehearsedCalibration, RehearsedSensor};
pub use result::*;
