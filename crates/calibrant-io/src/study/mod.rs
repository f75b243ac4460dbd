//! Writes `study.json`: every study that was run, sensor by sensor.

mod calibration;
mod improvement;
mod surface;

use super::json;
use calibrant_core::error::Result;
use calibrant_study::Studies;
use calibration::StudyFields;
use improvement::DesignStudyFields;
use serde::Serialize;
use std::path::Path;
use surface::SurfaceFields;

/// Writes `study.json`: of each study the conditions, the summary, every sensor, and the case in detail
/// (without its samples). It is `null` where a study was not run.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_study(path: &Path, studies: &Studies) -> Result<()> {
    json::write_json(path, &StudiesFile::of(studies))
}

/// The text that [`write_study`] writes.
#[must_use]
pub fn study_json(studies: &Studies) -> String {
    json::to_json(&StudiesFile::of(studies))
}

#[derive(Serialize)]
struct StudiesFile<'a> {
    schema: u32,
    program: String,
    remarks: &'a [String],
    calibration: Option<StudyFields<'a>>,
    surface: Option<SurfaceFields<'a>>,
    design: Option<DesignStudyFields<'a>>,
    noisy: Option<DesignStudyFields<'a>>,
}

impl<'a> StudiesFile<'a> {
    fn of(studies: &'a Studies) -> Self {
        Self {
            schema: 1,
            program: crate::atomic_output::program(),
            remarks: &studies.remarks,
            calibration: studies.calibration.as_ref().map(StudyFields::of),
            surface: studies.surface.as_ref().map(SurfaceFields::of),
            design: studies.design.as_ref().map(DesignStudyFields::of),
            noisy: studies.noisy.as_ref().map(DesignStudyFields::of),
        }
    }
}
