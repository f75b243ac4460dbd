//! Where a recording is: in files, or in memory.

use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuRecording, SensorKind};
use calibrant_io::{
    HashedFile, ImuFile, ImuReadOptions, Input, Section, file_name, imu_from_columns, imu_pair_of,
    parse_imu_recording, read_imu_pair, read_imu_recording, read_imu_sensor, read_sections,
};
use std::path::{Path, PathBuf};

/// The readings of a recording: a file of any format or its bytes, a table of columns, or a recording that is made already.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    path: PathBuf,
    content: Content,
}

#[derive(Debug, Clone, PartialEq)]
enum Content {
    File,
    Bytes(Vec<u8>),
    Columns(Vec<(String, Vec<f64>)>),
    Read(Box<ImuFile>),
}

impl Readings {
    /// A file.
    #[must_use]
    pub fn file(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), content: Content::File }
    }

    /// The bytes of a file, of any format. Results and errors call it by this name.
    #[must_use]
    pub fn bytes(name: impl Into<PathBuf>, bytes: Vec<u8>) -> Self {
        Self { path: name.into(), content: Content::Bytes(bytes) }
    }

    /// A table in memory, as [`imu_from_columns`] takes it. Results and errors call it by this name, as they would a file.
    #[must_use]
    pub fn columns(name: impl Into<PathBuf>, columns: &[(&str, &[f64])]) -> Self {
        let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec()));
        Self { path: name.into(), content: Content::Columns(columns.collect()) }
    }

    /// A recording that was made, or read, elsewhere. Results and errors call it by this name, as they would a file.
    #[must_use]
    pub fn recording(name: impl Into<PathBuf>, recording: impl Into<ImuRecording>) -> Self {
        Self::read_already(name, ImuFile::of_recording(recording.into()))
    }

    /// A recording that was read, with what was noticed in it. What a task says of its files does not count for it.
    #[must_use]
    pub fn read_already(name: impl Into<PathBuf>, file: ImuFile) -> Self {
        Self { path: name.into(), content: Content::Read(Box::new(file)) }
    }

    /// The path of the file, or the name of what is in memory.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Is it in a file?
    #[must_use]
    pub fn is_file(&self) -> bool {
        self.content == Content::File
    }

    /// What it is, by its content; `None` for a file that cannot be read.
    fn hashed(&self) -> Option<HashedFile> {
        let name = || file_name(&self.path);
        match &self.content {
            Content::File => HashedFile::of(&self.path),
            Content::Bytes(bytes) => Some(HashedFile::of_bytes(name(), bytes)),
            Content::Columns(columns) => {
                let columns = columns.iter().map(|(name, values)| (name.as_str(), values.clone()));
                Some(HashedFile::of_numbers(name(), &columns.collect::<Vec<_>>()))
            }
            Content::Read(file) => Some(HashedFile { file: name(), sha256: file.sha256.concat() }),
        }
    }

    /// Reads it, with the options of a file.
    pub(crate) fn read(&self, options: &ImuReadOptions) -> Result<ImuFile> {
        match &self.content {
            Content::File => read_imu_recording(&self.path, options),
            Content::Bytes(bytes) => {
                parse_imu_recording(bytes, options).map_err(|error| error.in_recording(&self.path))
            }
            Content::Columns(columns) => {
                let columns: Vec<(&str, &[f64])> =
                    columns.iter().map(|(name, values)| (name.as_str(), values.as_slice())).collect();
                imu_from_columns(&columns, options).map_err(|error| error.in_recording(&self.path))
            }
            Content::Read(file) => {
                let mut file = file.as_ref().clone();
                if let Some(only) = options.accelerometer_only {
                    let accelerometer = file.recording[SensorKind::Accelerometer].take();
                    file.recording[SensorKind::Accelerometer] =
                        accelerometer.map(|of| of.with_axes(only.axes));
                    file.recording[SensorKind::Gyroscope] = None;
                }
                Ok(file)
            }
        }
    }
}

impl<P: Into<PathBuf>> From<P> for Readings {
    fn from(path: P) -> Self {
        Self::file(path)
    }
}

/// The sections of a Ferraris session: faces and turns.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionList {
    /// In a file, as imucal writes it.
    File(PathBuf),
    /// In memory.
    InMemory(Vec<Section>),
}

impl SectionList {
    /// The list, and what errors call it.
    pub(crate) fn read(&self) -> Result<(Vec<Section>, &Path)> {
        match self {
            Self::File(path) => Ok((read_sections(path)?, path)),
            Self::InMemory(sections) => Ok((sections.clone(), Path::new("sections"))),
        }
    }
}

/// A recording: one for both sensors of an IMU or for an accelerometer, or one for each sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The recording, or the accelerometer's of a pair.
    pub recording: Readings,
    /// The gyroscope's of a pair.
    pub gyroscope: Option<Readings>,
    /// The sections of a Ferraris session: faces and turns.
    pub sections: Option<SectionList>,
    /// Further recordings of the same sensors, which are calibrated together with this one. Between one and the next nothing is known of the motion.
    pub further: Vec<Source>,
}

impl Source {
    /// A recording in one piece.
    #[must_use]
    pub fn new(recording: impl Into<Readings>) -> Self {
        Self { recording: recording.into(), gyroscope: None, sections: None, further: Vec::new() }
    }

    /// A recording in one file.
    #[must_use]
    pub fn from_file(recording: impl Into<PathBuf>) -> Self {
        Self::new(Readings::file(recording))
    }

    /// A table in memory ([`Readings::columns`]).
    #[must_use]
    pub fn from_columns(name: impl Into<PathBuf>, columns: &[(&str, &[f64])]) -> Self {
        Self::new(Readings::columns(name, columns))
    }

    /// A recording in memory ([`Readings::recording`]).
    #[must_use]
    pub fn from_recording(name: impl Into<PathBuf>, recording: impl Into<ImuRecording>) -> Self {
        Self::new(Readings::recording(name, recording))
    }

    /// The path of the recording, or its name.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.recording.path()
    }

    /// Reads both sensors of an IMU, from one recording or from two.
    ///
    /// # Errors
    /// As [`read_imu_recording`].
    pub fn read_imu(&self, options: &ImuReadOptions) -> Result<ImuFile> {
        match &self.gyroscope {
            None => self.recording.read(options),
            Some(gyroscope) if self.recording.is_file() && gyroscope.is_file() => {
                read_imu_pair(self.recording.path(), gyroscope.path(), options)
            }
            Some(gyroscope) => Ok(imu_pair_of(self.recording.read(options)?, gyroscope.read(options)?)),
        }
    }

    /// Reads a recording that holds this sensor, whose columns need not name it.
    pub(crate) fn read_sensor(&self, sensor_kind: SensorKind, options: &ImuReadOptions) -> Result<ImuFile> {
        match &self.gyroscope {
            None if self.recording.is_file() => read_imu_sensor(self.path(), sensor_kind, options),
            _ => self.read_imu(options),
        }
    }

    /// Itself, and the further recordings.
    pub(crate) fn each(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.further)
    }

    /// The paths of all its readings, its own first.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.each().flat_map(Self::paths)
    }

    /// Its [files](Self::files) by their content; `None` where one cannot be read.
    pub fn hashed(&self) -> Option<Vec<HashedFile>> {
        let readings =
            self.each().flat_map(|source| std::iter::once(&source.recording).chain(&source.gyroscope));
        readings.map(Readings::hashed).collect()
    }

    /// The paths of its readings, in the order of the sensors.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(self.path()).chain(self.gyroscope.as_ref().map(Readings::path))
    }

    /// Its files as results name them. `sha256`: of each; `of_one`: whose samples count where both sensors are in one file.
    #[must_use]
    pub fn inputs(&self, sha256: &[String], recording: &ImuRecording, of_one: SensorKind) -> Vec<Input> {
        let kinds = if self.gyroscope.is_some() { SensorKind::ALL } else { [of_one; 2] };
        let files = self.paths().zip(sha256).zip(kinds);
        files.map(|((path, sha256), kind)| Input::of(path, sha256, recording.sensor(kind))).collect()
    }

    /// The path of its readings of a sensor.
    pub(crate) fn path_of(&self, sensor_kind: SensorKind) -> &Path {
        match (sensor_kind, &self.gyroscope) {
            (SensorKind::Gyroscope, Some(gyroscope)) => gyroscope.path(),
            _ => self.path(),
        }
    }

    /// The name of the file that something was found in: the gyroscope's, or the other.
    pub(crate) fn name(&self, of_gyroscope: bool) -> String {
        let gyroscope = self.gyroscope.as_ref().filter(|_| of_gyroscope);
        file_name(gyroscope.unwrap_or(&self.recording).path())
    }
}
