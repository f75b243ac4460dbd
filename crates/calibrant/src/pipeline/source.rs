//! Where a recording lies.

use calibrant_core::sensor::SensorKind;
use calibrant_io::file_name;
use std::path::{Path, PathBuf};

/// The files of a recording: one for both sensors of an IMU or for an accelerometer, or one for each sensor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The recording, or the accelerometer's file of a pair.
    pub recording: PathBuf,
    /// The gyroscope's file of a pair.
    pub gyroscope: Option<PathBuf>,
    /// The list of the sections of a Ferraris session: faces and turns.
    pub sections: Option<PathBuf>,
    /// Further recordings of the same accelerometer, which are calibrated together with the first.
    pub further: Vec<PathBuf>,
}

impl Source {
    /// A recording in one file.
    #[must_use]
    pub fn from_file(recording: impl Into<PathBuf>) -> Self {
        Self { recording: recording.into(), gyroscope: None, sections: None, further: Vec::new() }
    }

    /// Its files of readings, in the order of the sensors.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(self.recording.as_path()).chain(self.gyroscope.as_deref())
    }

    /// Its file of readings of a sensor.
    pub(crate) fn file_of(&self, sensor_kind: SensorKind) -> &Path {
        match (sensor_kind, &self.gyroscope) {
            (SensorKind::Gyroscope, Some(gyroscope)) => gyroscope,
            _ => &self.recording,
        }
    }

    /// The name of the file that something was found in: the gyroscope's, or the other.
    pub(crate) fn name(&self, of_gyroscope: bool) -> String {
        file_name(self.gyroscope.as_deref().filter(|_| of_gyroscope).unwrap_or(&self.recording))
    }
}
