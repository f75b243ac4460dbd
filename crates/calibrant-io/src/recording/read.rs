//! Reads a recording of an accelerometer: line by line, then as a whole.

use super::checksum::hex_sha256;
use super::columns::Columns;
use super::finding_words::count;
use super::reader_finding::Finding;
use super::row_reader::Rows;
use super::size::{LARGEST, estimated_rows};
use super::{ReadOptions, RecordingFile, lost_sign, recording_quality};
use crate::delimited_text::Lines;
use crate::text_decoding::{self, Checked};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::Recording;
use std::path::Path;

/// Reads a recording.
///
/// # Errors
/// [`Error::Recording`] with file, line and column. The file cannot be read or is not text. Columns are
/// missing, or units contradict each other. A row has too few or too many columns, or a field that is not a
/// number. |t| is above 1e12. |reading| is above 1e12 in more than one row of 50, or above 1e300; fewer are
/// invalid samples. A time goes backwards. There are fewer than two samples.
pub fn read_recording(path: &Path, options: &ReadOptions) -> Result<RecordingFile> {
    let bytes = text_decoding::read_bytes(path, LARGEST, "the recording")
        .map_err(|input_error| Error::recording(*input_error))?;
    parse(&bytes, options).map_err(|input_error| Error::recording(input_error.in_file(path)))
}

/// Reads the bytes of a recording.
///
/// # Errors
/// As [`read_recording`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_io::{ReadOptions, parse_recording};
/// use calibrant_core::sensor::ReadingUnit;
///
/// let options = ReadOptions { unit: None, expected_unit: ReadingUnit::MetrePerSecondSquared, axes: 3 };
/// let file = parse_recording(b"t_s,ax_g,ay_g,az_g\n0.00,0,0,1\n0.01,0,0,1\n", &options)?;
/// assert_eq!(file.recording.readings[0].z, 9.80665);
/// assert!(file.findings[0].to_string().contains("axis x never changes"));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_recording(bytes: &[u8], options: &ReadOptions) -> Result<RecordingFile> {
    parse(bytes, options).map_err(|input_error| Error::recording(*input_error))
}

pub(super) fn parse(bytes: &[u8], options: &ReadOptions) -> Checked<RecordingFile> {
    let text = text_decoding::as_text(bytes)?;
    if options.axes != 1 && options.axes != 3 {
        return Err(InputError::new(
            Refusal::ValueInvalid,
            format!("{} axes are not supported", options.axes),
            "1 or 3",
        )
        .into());
    }
    let mut findings = Vec::new();
    let mut lines = Lines::of(text);
    let Some(first) = lines.by_ref().find(|line| !line.is_void()) else {
        return Err(InputError::new(
            Refusal::FileEmpty,
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
    rows.check_invalid()?;
    rows.report(&mut findings);
    if rows.times_s.len() < 2 {
        return Err(too_short(&rows, last, &findings).into());
    }
    let Rows { times_s, readings, lines, .. } = rows;
    let recording = Recording { times_s, readings, axes: options.axes, unit: columns.unit };
    lost_sign::check(&recording, "")?;
    recording_quality::examine(&recording, &lines, &mut findings);
    Ok(RecordingFile { recording, findings, sha256: hex_sha256(bytes), lines: last })
}

pub(super) fn too_short(rows: &Rows<'_>, last: usize, findings: &[Finding]) -> InputError {
    let message = match rows.rows() {
        0 => "there is a header but no sample below it".to_owned(),
        n => format!("only {} in {}", count(rows.times_s.len(), "usable sample"), count(n, "row")),
    };
    let mut help = vec!["a recording needs two samples at least".to_owned()];
    help.extend(findings.iter().map(ToString::to_string));
    InputError::new(Refusal::RecordingShort, message, help.join("; ")).at_line(last)
}
