//! Takes the data set of a fleet up into records.

use super::part::{each_piece, parts, refused};
use super::row::DatasetRow;
use crate::database::Records;
use calibrant_core::error::Result;
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// What became of a data set.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Imported {
    /// Calibrations that are new.
    pub new: usize,
    /// Those that took the place of the same calibration.
    pub replaced: usize,
    /// Rows without a calibration.
    pub without_calibration: usize,
    /// Recordings with the same bytes under the names of several sensors, by their files. None of them was taken up.
    pub copies: Vec<Vec<String>>,
}

/// What tells copies.
#[derive(Deserialize)]
struct Named {
    file: String,
    sensor: String,
    recording_sha256: String,
}

impl Records {
    /// Takes up the data set of a fleet: a folder with files of Parquet, or one such file. What is there already takes its own place again.
    ///
    /// A recording that stands under the names of several sensors is left out: nobody knows of which it is.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) names the part and its row that cannot be read. As [`insert_all`](Self::insert_all).
    /// The parts before it stay; the next call completes them.
    pub fn import(&mut self, data_set: &Path) -> Result<Imported> {
        let parts = parts(data_set)?;
        let copies = copies(&parts)?;
        let mut done = Imported::default();
        for part in &parts {
            done.without_calibration += each_piece(part, None, |rows: Vec<(usize, DatasetRow)>| {
                let rows = rows.into_iter().filter(|(_, row)| !copies.contains_key(&row.recording_sha256));
                let records = rows
                    .map(|(number, row)| row.into_record().map_err(|error| refused(part, number, *error)));
                let records = records.collect::<Result<Vec<_>>>()?;
                let given = records.len();
                let new = self.insert_all(records)?;
                (done.new, done.replaced) = (done.new + new, done.replaced + given - new);
                Ok(())
            })?;
        }
        done.copies = copies.into_values().collect();
        Ok(done)
    }
}

/// The files of each recording that has several sensors, by its hash.
fn copies(parts: &[PathBuf]) -> Result<BTreeMap<String, Vec<String>>> {
    let mut first: HashMap<String, (String, String)> = HashMap::new();
    let mut copies: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for part in parts {
        let columns = ["file", "sensor", "recording_sha256", "verdict"];
        each_piece(part, Some(&columns), |rows: Vec<(usize, Named)>| {
            for (_, Named { file, sensor, recording_sha256 }) in rows {
                let (other, path) =
                    first.entry(recording_sha256.clone()).or_insert_with(|| (sensor.clone(), file.clone()));
                if *other != sensor {
                    copies.entry(recording_sha256).or_insert_with(|| vec![path.clone()]).push(file);
                }
            }
            Ok(())
        })?;
    }
    Ok(copies)
}
