//! `recording.csv`.

use crate::error::Result;
use crate::io::output::write_atomically;
use crate::sensor::Recording;
use std::path::Path;

/// Writes a recording as CSV with the header `t_s,ax_mps2,ay_mps2,az_mps2` (or `_counts`; only `ax` for one axis).
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Output`](crate::Error::Output) where it cannot be written.
pub fn write_recording(path: &Path, recording: &Recording) -> Result<()> {
    write_atomically(path, |out| {
        write!(out, "t_s")?;
        for axis in recording.active_axes() {
            write!(out, ",a{axis}_{}", recording.unit.suffix())?;
        }
        writeln!(out)?;
        for (t, reading) in recording.times_s.iter().zip(&recording.readings) {
            write!(out, "{t:?}")?;
            for value in &reading.as_slice()[..recording.axes] {
                write!(out, ",{value:?}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}
