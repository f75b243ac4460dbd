//! The format of a table.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::path::Path;

/// The format of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated text.
    Csv,
    /// Apache Parquet.
    Parquet,
}

impl TableFormat {
    /// The format that the ending of a name says.
    ///
    /// # Errors
    /// [`Error::Experiment`] for an ending that is neither `.csv` nor `.parquet`, and where this build writes no Parquet.
    pub fn of(path: &Path) -> Result<Self> {
        let refused = |refusal, message, help| {
            Err(Error::experiment(InputError::new(refusal, message, help).in_file(path)))
        };
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
        match ending.as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("parquet") if cfg!(feature = "parquet") => Ok(Self::Parquet),
            Some("parquet") => {
                refused(Refusal::FormatUnsupported, "this build writes no Parquet", "write CSV")
            }
            _ => {
                let message = "the ending of this name is neither .csv nor .parquet";
                refused(Refusal::FormatUnknown, message, "give the table one of these endings")
            }
        }
    }
}
