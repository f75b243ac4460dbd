//! `study.json`: every study that was run, sensor by sensor.

use super::heading::{Heading, JsonFile};
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_study::Studies;

/// The content of `study.json`: of each study the conditions, the summary, every sensor, and the case in detail (without its samples). It is
/// `null` where a study was not run.
#[derive(Debug, Clone, Copy)]
pub struct StudyFile<'a> {
    /// The studies.
    pub studies: &'a Studies,
}

json_object! {
    /// Studies of simulated sensors: those that were run.
    StudyFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        notes: &file.studies.notes,
        /// Truth and estimate of a population.
        calibration: &file.studies.calibration,
        surface: &file.studies.surface,
        /// Initial against optimal motion.
        design: &file.studies.design,
        /// The same with process noise.
        noisy: &file.studies.noisy,
        /// Of a machine: plain routine against best trajectory.
        rehearsal: &file.studies.rehearsal,
    }
}

impl JsonFile for StudyFile<'_> {
    const KIND: &'static str = "study";
}
