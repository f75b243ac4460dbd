//! Reads a log of a motion in any format.

use super::file::ReferenceLogFile;
#[cfg(feature = "mcap")]
use super::format::ReferenceFormat;
use super::log_assembly::assemble;
use super::log_head::head_and_columns;
#[cfg(feature = "mcap")]
use super::mcap;
use super::options::ReferenceLogOptions;
use super::rows::LogReader;
use crate::files::checksum::hex_sha256;
use crate::recording::bag_kind::BagKind;
use crate::recording::chunked_reader::FileBeginning;
use crate::recording::text_source::{self, Source};
use crate::text::decoding::Checked;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::ColumnsIgnored;
use calibrant_core::error::{Error, InputError, Result};
use std::path::Path;

/// Does a file that begins so hold a bag?
pub(super) fn is_bag(bytes: &[u8]) -> bool {
    BagKind::of(bytes).is_some()
}

/// Reads a log of joints or poses in any known format.
///
/// # Errors
/// [`Error::Recording`] with file, line and column. The file cannot be read, or its content is of no known
/// format. A column is missing or there twice. The unit of the times is not stated. A row has the wrong number
/// of columns, or a field that is not a number or not finite. A quaternion has a norm far from 1. A time goes
/// backwards. Fewer than two rows hold anything.
pub fn read_reference_log(path: &Path, options: &ReferenceLogOptions) -> Result<ReferenceLogFile> {
    let in_file = |input_error: Box<InputError>| Error::recording(input_error.in_file(path));
    let beginning = FileBeginning::read(path, is_bag).map_err(in_file)?;
    if is_bag(&beginning.bytes) {
        return parse(&beginning.bytes, options).map_err(in_file);
    }
    let read = text_source::of_file(beginning, |source| parse_text(source, options));
    read.map(with_checksum).map_err(in_file)
}

/// Reads the bytes of a log.
///
/// # Errors
/// As [`read_reference_log`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_recording::{ReferenceFormat, ReferenceLogOptions, parse_reference_log};
///
/// let text = b"t_s,elbow_deg,rail_mm\n0.00,90,100\n0.01,91,nan\n";
/// let file = parse_reference_log(text, &ReferenceLogOptions::default())?;
/// assert_eq!(file.format, ReferenceFormat::Joints);
/// let joints = file.joints().expect("a log of joints");
/// assert_eq!(joints.names, ["elbow", "rail"]);
/// assert_eq!(joints.row(0), [std::f64::consts::FRAC_PI_2, 0.1]);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_reference_log(bytes: &[u8], options: &ReferenceLogOptions) -> Result<ReferenceLogFile> {
    parse(bytes, options).map_err(Error::Recording)
}

fn parse(bytes: &[u8], options: &ReferenceLogOptions) -> Checked<ReferenceLogFile> {
    if let Some(kind) = BagKind::of(bytes) {
        let (file, sha256) = rayon::join(|| read_mcap(kind, bytes, options), || hex_sha256(bytes));
        return Ok(with_checksum((file?, sha256)));
    }
    text_source::of_bytes(bytes, |source| parse_text(source, options)).map(with_checksum)
}

fn with_checksum((file, sha256): (ReferenceLogFile, String)) -> ReferenceLogFile {
    ReferenceLogFile { sha256, ..file }
}

/// The comment of a log that states the distance of the knots.
pub(super) const KNOT_STEP: &str = "knot_step_s";

fn parse_text(source: Source<'_>, options: &ReferenceLogOptions) -> Checked<ReferenceLogFile> {
    let (head, columns) = head_and_columns(source.text, options).map_err(without_table)?;
    let line = head.line();
    let knot_step_s = head.number(KNOT_STEP);
    let layout = columns.layout(head.delimiter);
    let mut reader = LogReader::new(&layout, &columns, source.estimated_rows(&head));
    source.read_rows(head, &mut reader)?;
    let mut rows = reader.finish();
    rows.last_line = rows.last_line.or(Some(line));
    let ignored = columns.ignored();
    let clock = (columns.time_name(), columns.time_unit);
    let mut findings: Vec<_> = columns.values.assumed.into_iter().collect();
    if !ignored.is_empty() {
        let found = ColumnsIgnored { columns: ignored, other: None };
        findings.push(Diagnostic::from(found).at_line(Some(line)));
    }
    let mut file = assemble(columns.format, columns.values.content, (&clock.0, clock.1), rows, findings)?;
    file.knot_step_s = file.knot_step_s.or(knot_step_s);
    Ok(file)
}

/// The error about a text without a table, with the remedy for a log.
fn without_table(mut input_error: Box<InputError>) -> Box<InputError> {
    if input_error.help.starts_with("a recording has") {
        input_error.help = "a log of a motion has a row for each sample, below a header such as t_s,elbow_rad or t_s,px_m,py_m,pz_m,qw,qx,qy,qz".into();
    }
    input_error
}

#[cfg(feature = "mcap")]
fn read_mcap(kind: BagKind, bytes: &[u8], options: &ReferenceLogOptions) -> Checked<ReferenceLogFile> {
    let format = match kind {
        BagKind::Mcap => ReferenceFormat::Mcap,
        BagKind::Db3 => ReferenceFormat::Db3,
        BagKind::Rosbag => ReferenceFormat::Rosbag,
    };
    mcap::read(format, bytes, options.topic.as_deref())
}

#[cfg(not(feature = "mcap"))]
fn read_mcap(_: BagKind, _: &[u8], _: &ReferenceLogOptions) -> Checked<ReferenceLogFile> {
    crate::text::decoding::without("mcap")
}
