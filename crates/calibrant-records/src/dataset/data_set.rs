//! A data set that was read once: its parts, and the copies in it.

use super::row::{DatasetRow, unfit};
use crate::record::{Record, together};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_io::{Checked, ParquetRows};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// Rows that are in memory at a time.
const PIECE: usize = 1000;

/// The data set of a fleet. Each row was read, and makes sense.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataSet {
    pub(super) parts: Vec<PathBuf>,
    /// Rows without a calibration.
    pub(super) without_calibration: usize,
    /// The files of each recording that stands under the names of several sensors, by its hash.
    pub(super) copies: BTreeMap<String, Vec<String>>,
}

/// A row as it stands in a part.
#[derive(Deserialize)]
struct InPart {
    file: String,
    #[serde(flatten)]
    row: DatasetRow,
}

impl DataSet {
    /// Reads a folder with files of Parquet, or one such file.
    ///
    /// # Errors
    /// [`Error::Experiment`] where there is none, and names the part and its row that cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let mut found = Self { parts: parts(path)?, without_calibration: 0, copies: BTreeMap::new() };
        let mut first: HashMap<String, (String, String)> = HashMap::new();
        for part in found.parts.clone() {
            found.without_calibration += each_piece(&part, |rows| {
                for (file, Record { sensor, recordings, .. }) in rows {
                    let sha256 = together(&recordings);
                    let (other, its_file) =
                        first.entry(sha256.clone()).or_insert_with(|| (sensor.clone(), file.clone()));
                    if *other != sensor {
                        found.copies.entry(sha256).or_insert_with(|| vec![its_file.clone()]).push(file);
                    }
                }
                Ok(())
            })?;
        }
        Ok(found)
    }
}

/// The files of Parquet in a folder, by their names; or one such file.
fn parts(data_set: &Path) -> Result<Vec<PathBuf>> {
    if data_set.is_file() {
        return Ok(vec![data_set.to_path_buf()]);
    }
    let refused = |message: String| {
        let help = "give the folder of a data set that `calibrant.fleet.calibrate` wrote";
        Error::experiment(InputError::new(Refusal::FileUnreadable, message, help).in_file(data_set))
    };
    let unreadable = |error: std::io::Error| refused(format!("cannot read the data set: {error}"));
    let listed = std::fs::read_dir(data_set).map_err(unreadable)?;
    let paths = listed.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = paths.collect::<std::io::Result<Vec<_>>>().map_err(unreadable)?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "parquet"));
    paths.sort();
    match paths.is_empty() {
        true => Err(refused("there is no file of Parquet in this folder".to_owned())),
        false => Ok(paths),
    }
}

/// Hands on the calibrations of a part with their files, some at a time. Gives the number of rows without one.
pub(super) fn each_piece(
    part: &Path,
    mut take: impl FnMut(Vec<(String, Record)>) -> Result<()>,
) -> Result<usize> {
    let (mut rows, mut number, mut without) = (ParquetRows::open(part)?, 0, 0);
    loop {
        let values = rows.next_rows(PIECE)?;
        if values.is_empty() {
            return Ok(without);
        }
        let mut piece = Vec::new();
        for value in values {
            number += 1;
            if value.get("verdict").is_some_and(|verdict| verdict == "none") {
                without += 1;
                continue;
            }
            let record = record_of(value).map_err(|mut error| {
                error.message = format!("row {number}: {}", error.message);
                Error::experiment(error.in_file(part))
            });
            piece.push(record?);
        }
        take(piece)?;
    }
}

fn record_of(row: Value) -> Checked<(String, Record)> {
    let InPart { file, row } = serde_json::from_value(row).map_err(|error| unfit(error.to_string()))?;
    Ok((file, row.into_record()?))
}
