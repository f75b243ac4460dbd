//! Recordings: delimited text in many dialects, read in one pass, checked row by row and as a whole.
//!
//! | content | recognised by |
//! |---|---|
//! | `t_s,ax,ay,az`, axes optionally ending in `_mps2`, `_counts`, `_g` | its header |
//! | `t x y z` (imu_tk's `.mat` files and many others) | a first row of numbers |
//!
//! Every other format is that of a whole IMU (`imu/`); [`read_accelerometer`] takes its accelerometer alone.
//!
//! Delimiters: comma, semicolon, tab or white space, found in the first line. Comment lines (`#`, `//`, `%`), blank lines, a byte
//! order mark and line ends of any system are fine. What can be repaired is repaired and told as a [`Finding`]; what would change
//! the answer unnoticed is an error.

mod columns;
mod finding;
mod imu;
mod pieces;
mod quality;
mod row;
mod rows;
mod signed;
mod write;

pub use finding::{Finding, FindingKind};
pub use imu::{
    ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile, ImuReadOptions, ImuUnit,
    SecondFile, TimeUnit, parse_imu_pair, parse_imu_recording, read_accelerometer, read_imu_pair,
    read_imu_recording, read_imu_sensor,
};
pub use write::{write_imu_recording, write_recording};

use super::delimited::Lines;
use super::text::{self, Checked};
use crate::error::{Complaint, Error, Result};
use crate::sensor::{ReadingUnit, Recording};
use columns::Columns;
use finding::count;
use rows::Rows;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Largest recording, bytes.
const LARGEST: u64 = 8 << 30;
/// Fewest bytes that a row can have: `0 0 0 0` and a line end. Bounds the memory reserved ahead.
const LEAST_ROW_BYTES: usize = 8;

/// How a recording is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// Unit of the readings where the user gives it (`--unit`); a header that contradicts it is an error.
    pub unit: Option<ReadingUnit>,
    /// Unit that the experiment expects: that of the readings where neither the header nor the user says.
    pub expected_unit: ReadingUnit,
    /// Number of axes that are needed, 1 or 3.
    pub axes: usize,
}

/// A recording as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingFile {
    /// The samples: times strictly increasing, everything finite. Its unit is the file's, which may differ from the expected one
    /// (there is a finding then).
    pub recording: Recording,
    /// What was noticed and repaired.
    pub findings: Vec<Finding>,
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// Number of lines of the file.
    pub lines: usize,
}

/// Reads a recording.
///
/// # Errors
/// [`Error::Recording`] with file, line and column: a file that cannot be read or is not text; columns missing, or units that
/// contradict each other; a row with too few or too many columns, or something that is not a number; |t| above 1e12, or |reading|
/// in more than one row of 50 (fewer are wild samples; none above 1e300);
/// a time that goes backwards; fewer than two samples.
pub fn read_recording(path: &Path, options: &ReadOptions) -> Result<RecordingFile> {
    let bytes =
        text::read_bytes(path, LARGEST, "the recording").map_err(|complaint| Error::recording(*complaint))?;
    parse(&bytes, options).map_err(|complaint| Error::recording(complaint.in_file(path)))
}

/// Reads the bytes of a recording.
///
/// # Errors
/// As [`read_recording`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant::io::{ReadOptions, parse_recording};
/// use calibrant::sensor::ReadingUnit;
///
/// let options = ReadOptions { unit: None, expected_unit: ReadingUnit::MetrePerSecondSquared, axes: 3 };
/// let file = parse_recording(b"t_s,ax_g,ay_g,az_g\n0.00,0,0,1\n0.01,0,0,1\n", &options)?;
/// assert_eq!(file.recording.readings[0].z, 9.80665);
/// assert!(file.findings[0].to_string().contains("axis x never changes"));
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn parse_recording(bytes: &[u8], options: &ReadOptions) -> Result<RecordingFile> {
    parse(bytes, options).map_err(|complaint| Error::recording(*complaint))
}

fn parse(bytes: &[u8], options: &ReadOptions) -> Checked<RecordingFile> {
    let text = text::as_text(bytes)?;
    if options.axes != 1 && options.axes != 3 {
        return Err(Complaint::new(format!("{} axes are not supported", options.axes), "1 or 3").into());
    }
    let mut findings = Vec::new();
    let mut lines = Lines::of(text);
    let Some(first) = lines.by_ref().find(|line| !line.is_void()) else {
        return Err(Complaint::new(
            if text.trim().is_empty() { "the file is empty" } else { "the file has only comments" },
            "a recording has a header t_s,ax,ay,az and a row for each sample",
        )
        .into());
    };
    first.check_ends()?;
    let columns = Columns::find(first, options, &mut findings)?;
    let capacity = estimated_rows(text, first.text, text.len());
    let mut rows = Rows::new(&columns, capacity);
    rows.look_at_the_end(text);
    let mut last = first.number;
    if !columns.layout.has_header {
        rows.take(first)?;
    }
    for line in lines {
        last = line.number;
        rows.take(line)?;
    }
    rows.check_wild()?;
    rows.report(&mut findings);
    if rows.times_s.len() < 2 {
        return Err(too_short(&rows, last, &findings).into());
    }
    let Rows { times_s, readings, lines, .. } = rows;
    let recording = Recording { times_s, readings, axes: options.axes, unit: columns.unit };
    signed::check(&recording, "")?;
    quality::examine(&recording, &lines, &mut findings);
    Ok(RecordingFile { recording, findings, sha256: hex_sha256(bytes), lines: last })
}

fn too_short(rows: &Rows<'_>, last: usize, findings: &[Finding]) -> Complaint {
    let message = match rows.rows() {
        0 => "there is a header but no sample below it".to_owned(),
        n => format!("only {} in {}", count(rows.times_s.len(), "usable sample"), count(n, "row")),
    };
    let mut help = vec!["a recording needs two samples at least".to_owned()];
    help.extend(findings.iter().map(ToString::to_string));
    Complaint::new(message, help.join("; ")).at_line(last)
}

/// About how many rows a text of this length has, from the lines in the middle of this part of it.
fn estimated_rows(text: &str, first: &str, length: usize) -> usize {
    const PROBE: usize = 4096;
    let middle = text.len() / 2;
    let probe = &text.as_bytes()[middle..text.len().min(middle + PROBE)];
    let ends = probe.iter().filter(|&&byte| byte == b'\n').count();
    let row = if ends > 1 { probe.len() / ends } else { first.len() };
    length / row.max(LEAST_ROW_BYTES) + 16
}

fn hex_sha256(bytes: &[u8]) -> String {
    hex(Sha256::new_with_prefix(bytes))
}

fn hex(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
