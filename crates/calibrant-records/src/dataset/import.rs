//! Takes the data set of a fleet up into records.

use super::data_set::{DataSet, each_piece};
use crate::database::Records;
use calibrant_core::error::Result;

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

impl Records {
    /// Takes up the data set of a fleet. What is there already takes its own place again.
    ///
    /// A recording that stands under the names of several sensors is left out: nobody knows of which it is.
    ///
    /// # Errors
    /// As [`insert_all`](Self::insert_all).
    pub fn import(&mut self, data_set: &DataSet) -> Result<Imported> {
        let (mut new, mut given) = (0, 0);
        for part in &data_set.parts {
            each_piece(part, |rows| {
                let records = rows.into_iter().map(|(_, record)| record);
                let records: Vec<_> = records
                    .filter(|record| !data_set.copies.contains_key(&record.recording_sha256()))
                    .collect();
                given += records.len();
                new += self.insert_all(records)?;
                Ok(())
            })?;
        }
        let copies = data_set.copies.values().cloned().collect();
        let without_calibration = data_set.without_calibration;
        Ok(Imported { new, replaced: given - new, without_calibration, copies })
    }
}
