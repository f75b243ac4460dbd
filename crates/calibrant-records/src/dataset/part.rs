//! The parts of a data set: its files of Parquet.

use super::row::unfit;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_io::ParquetRows;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// Rows that are in memory at a time.
const PIECE: usize = 1000;

/// The parts of a data set by their names: the files of Parquet in a folder, or one such file.
pub(super) fn parts(data_set: &Path) -> Result<Vec<PathBuf>> {
    if data_set.is_file() {
        return Ok(vec![data_set.to_path_buf()]);
    }
    let refused = |refusal, message: String| {
        let help = "give the folder of a data set that `calibrant.fleet.calibrate` wrote";
        Error::experiment(InputError::new(refusal, message, help).in_file(data_set))
    };
    let unreadable = |error: std::io::Error| refused(Refusal::FileUnreadable, error.to_string());
    let listed = std::fs::read_dir(data_set).map_err(unreadable)?;
    let paths = listed.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = paths.collect::<std::io::Result<Vec<_>>>().map_err(unreadable)?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "parquet"));
    paths.sort();
    match paths.is_empty() {
        true => Err(refused(Refusal::FileUnreadable, "there is no file of Parquet".to_owned())),
        false => Ok(paths),
    }
}

/// Hands on the rows of a part with their numbers, some at a time. One without a calibration is counted; gives how many.
pub(super) fn each_piece<T: DeserializeOwned>(
    part: &Path,
    columns: Option<&[&str]>,
    mut take: impl FnMut(Vec<(usize, T)>) -> Result<()>,
) -> Result<usize> {
    let (mut rows, mut number, mut without) = (ParquetRows::open(part, columns)?, 0, 0);
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
            let row = serde_json::from_value(value);
            let row = row.map_err(|error| refused(part, number, unfit(error.to_string())))?;
            piece.push((number, row));
        }
        take(piece)?;
    }
}

/// The error for a row of a part.
pub(super) fn refused(part: &Path, number: usize, error: InputError) -> Error {
    let message = format!("row {number}: {}", error.message);
    Error::experiment(InputError { message, ..error }.in_file(part))
}
