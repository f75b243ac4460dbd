//! A table of numbers as CSV.

use crate::files::atomic_output::write_atomically;
use calibrant_core::error::Result;
use std::path::Path;

/// Writes a table of numbers below this header. They have the fewest digits that read back to the same bits; what is
/// no number is `nan`.
pub fn write_numbers<R: IntoIterator<Item = f64>>(
    path: &Path,
    header: &str,
    rows: impl IntoIterator<Item = R>,
) -> Result<()> {
    write_atomically(path, |out| {
        writeln!(out, "{header}")?;
        for row in rows {
            for (k, value) in row.into_iter().enumerate() {
                let comma = if k > 0 { "," } else { "" };
                if value.is_nan() { write!(out, "{comma}nan")? } else { write!(out, "{comma}{value:?}")? }
            }
            writeln!(out)?;
        }
        Ok(())
    })
}
