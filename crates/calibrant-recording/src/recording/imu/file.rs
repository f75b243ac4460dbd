//! The data types of an IMU's recording as a file holds it.

use super::column::ImuColumn;
use super::format::FileFormat;
use super::unit::ColumnUnit;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::json_object;
use calibrant_core::sensor::{ImuRecording, PerSensor};

/// A recording of an IMU as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuFile {
    /// The samples: times in s, strictly increasing, everything finite; SI or counts.
    pub recording: ImuRecording,
    /// The format, as recognised or given; of a pair the accelerometer's.
    pub format: FileFormat,
    /// The columns in their order, used or not; of both files for a pair.
    pub columns: Vec<ImuColumn>,
    /// What was noticed and repaired; of a pair in the accelerometer's file.
    pub findings: Vec<Diagnostic>,
    /// Number of rows, dropped ones included; of a pair the accelerometer's.
    pub rows: usize,
    /// SHA-256 of the bytes of each file, hexadecimal.
    pub sha256: Vec<String>,
    /// The gyroscope's file of a pair.
    pub second: Option<SecondFile>,
    /// The time from which the times count, ns, where they count from their first and the file has another.
    pub counted_from_ns: Option<i128>,
    /// Standard deviation of the rate of the samples, ppm, where they have no clock that was recorded.
    pub rate_sd_ppm: Option<f64>,
}

impl ImuFile {
    /// All that was noticed, in the file or in both files of a pair.
    pub fn all_findings(&self) -> impl Iterator<Item = &Diagnostic> {
        self.findings.iter().chain(self.second.iter().flat_map(|second| &second.findings))
    }

    /// The same, each with the name of its file: the first, or the gyroscope's.
    #[must_use]
    pub fn findings_in(&self, name: &str, gyroscope: Option<&str>) -> Vec<Diagnostic> {
        let second = self.second.iter().flat_map(|second| &second.findings);
        let of_second = second.map(|found| found.clone().in_file(gyroscope.unwrap_or(name)));
        self.findings.iter().map(|found| found.clone().in_file(name)).chain(of_second).collect()
    }

    /// The sensitivity by which counts of each sensor became readings, counts per m/s² or rad/s.
    #[must_use]
    pub fn counts_per_unit(&self) -> PerSensor<Option<f64>> {
        let of_columns = self.columns.iter().filter_map(|column| match column.unit {
            Some(ColumnUnit::Reading(unit)) if column.unused.is_none() => unit.sensitivity(),
            _ => None,
        });
        let mut counts = PerSensor::default();
        of_columns.for_each(|of| counts[of.sensor_kind()] = Some(of.counts_per_unit()));
        counts
    }
}

/// The facts about the gyroscope's file of a pair.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondFile {
    /// The format, as recognised or given.
    pub format: FileFormat,
    /// Number of rows, dropped ones included.
    pub rows: usize,
    /// Number of its columns: the last ones of [`ImuFile::columns`].
    pub columns: usize,
    /// What was noticed in it.
    pub findings: Vec<Diagnostic>,
}

json_object! {
    SecondFile as second {
        /// The format of the file.
        format: second.format.name(),
        /// Number of rows.
        rows: second.rows,
        /// Number of its columns.
        columns: second.columns,
    }
}
