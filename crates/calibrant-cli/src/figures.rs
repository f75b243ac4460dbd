//! `--figures`: the figures of a report as files.

use calibrant::io::write_text;
use calibrant::report::Sheet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static DIRECTORY: OnceLock<PathBuf> = OnceLock::new();
static IS_WRITTEN: AtomicBool = AtomicBool::new(false);
/// No report has more figures.
const MOST: usize = 99;

/// Sets where they are written.
pub(crate) fn set(directory: Option<PathBuf>) {
    if let Some(directory) = directory {
        // fails only where it is set already
        let _ = DIRECTORY.set(directory);
    }
}

/// Every file that may be written.
pub(crate) fn places() -> Vec<PathBuf> {
    let of = |directory: &PathBuf| (1..=MOST).flat_map(|number| files(directory, number)).collect();
    DIRECTORY.get().map_or_else(Vec::new, of)
}

fn files(directory: &Path, number: usize) -> [PathBuf; 2] {
    ["svg", "csv"].map(|ending| directory.join(format!("figure-{number:02}.{ending}")))
}

/// Were figures asked for, and none written?
pub(crate) fn are_missing() -> bool {
    DIRECTORY.get().is_some() && !IS_WRITTEN.load(Ordering::Relaxed)
}

/// Writes the figures of a sheet, where that is asked for.
pub(crate) fn write(sheet: &Sheet<'_>) -> calibrant::Result<()> {
    let Some(directory) = DIRECTORY.get() else { return Ok(()) };
    for (number, figure) in (1..=MOST).zip(sheet.figures()) {
        let [svg, csv] = files(directory, number);
        write_text(&svg, &figure.svg)?;
        write_text(&csv, &figure.csv)?;
        IS_WRITTEN.store(true, Ordering::Relaxed);
    }
    Ok(())
}
