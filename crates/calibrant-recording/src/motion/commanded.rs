//! Reads and writes `motion.csv`: the nodes of a commanded motion. It reads `motion_dense.csv` as well.

use crate::text::decoding::{self, Checked, refuse};
use crate::text::delimited::{Delimiter, Line, Lines};
use crate::text::numbers::write_numbers;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;
use std::iter::once;
use std::path::Path;

/// Largest motion file, bytes.
const LARGEST_FILE: u64 = 1 << 30;
/// Largest plausible time (s) and acceleration (m/s²).
const LARGEST: f64 = 1e9;
/// The names of the columns.
const NAMES: [&str; 4] = ["t_s", "ax_mps2", "ay_mps2", "az_mps2"];
/// What `motion_dense.csv` has beside them, which follows from them.
const DENSE: [&str; 9] =
    ["px_m", "vx_mps", "jx_mps3", "py_m", "vy_mps", "jy_mps3", "pz_m", "vz_mps", "jz_mps3"];
/// Distance from a line, relative to the largest acceleration, that is rounding.
const STRAIGHT: f64 = 1e-9;

/// Reads the nodes of a motion: header `t_s,ax_mps2,ay_mps2,az_mps2`, one row for each node.
///
/// For one axis only `ax_mps2` is read (`ay_mps2` and `az_mps2` may be there). Delimiters and comments as in recordings.
/// Of the columns of `motion_dense.csv` ([`write_dense_motion`](crate::write_dense_motion)) it takes time and acceleration; rows on one line are one interval.
///
/// # Errors
/// [`Error::Experiment`] with file, line and column. The file cannot be read or is not text. A column is
/// missing, unknown or there twice. A row has the wrong number of columns, or a value that is missing, no
/// number, not finite or above 1e9. Times do not increase. There are fewer than two nodes.
pub fn read_motion(path: &Path, axes: usize) -> Result<JerkControlledMotion> {
    decoding::parsed(path, (LARGEST_FILE, "the motion"), |bytes| parse(bytes, axes))
}

/// Reads the bytes of a motion file.
///
/// # Errors
/// As [`read_motion`], without the name of the file.
///
/// # Examples
/// ```
/// let motion = calibrant_recording::parse_motion(b"t_s,ax_mps2\n0,0\n1,5\n", 1)?;
/// assert_eq!(motion.jerk_mps3()[0].x, 5.0);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_motion(bytes: &[u8], axes: usize) -> Result<JerkControlledMotion> {
    parse(bytes, axes).map_err(Error::Experiment)
}

/// Writes the nodes of a motion; numbers read back to the same bits.
///
/// # Errors
/// [`Error::Output`] where it cannot be written.
pub fn write_motion(path: &Path, motion: &JerkControlledMotion, axes: usize) -> Result<()> {
    let axes = axes.clamp(1, 3);
    let nodes = motion.times_s().iter().zip(motion.acceleration_mps2());
    let rows = nodes.map(|(t, node)| once(*t).chain(node.iter().take(axes).copied()));
    write_numbers(path, &NAMES[..=axes].join(","), rows)
}

fn parse(bytes: &[u8], axes: usize) -> Checked<JerkControlledMotion> {
    /// The remedy for a wrong header.
    const HELP: &str = "a motion has the header t_s,ax_mps2,ay_mps2,az_mps2 and a row for each node";
    let text = decoding::as_text(bytes)?;
    if axes != 1 && axes != 3 {
        return refuse(Refusal::ValueInvalid, format!("{axes} axes are not supported"), "1 or 3");
    }
    let mut lines = Lines::of(text).filter(|line| !line.is_void());
    let Some(header) = lines.next() else {
        return refuse(Refusal::FileEmpty, "the file is empty", HELP);
    };
    let delimiter = Delimiter::of(header.text);
    let (slots, is_dense) = read_header(header, delimiter, axes)?;
    let (mut times_s, mut nodes): (Vec<f64>, Vec<Vector3<f64>>) = (Vec::new(), Vec::new());
    for line in lines {
        let [t, x, y, z] = read_row(line, delimiter, &slots)?;
        if let Some(&before) = times_s.last().filter(|before| **before >= t) {
            return Err(InputError::new(
                Refusal::TimesNotIncreasing,
                format!("node times must increase: {t:?} s comes after {before:?} s"),
                "sort the rows and remove duplicates",
            )
            .at_line(line.number)
            .into());
        }
        times_s.push(t);
        nodes.push(Vector3::new(x, y, z));
    }
    if nodes.len() < 2 {
        let message = format!("a motion needs at least two nodes, this one has {}", nodes.len());
        return refuse(Refusal::MotionInvalid, message, HELP);
    }
    if is_dense {
        (times_s, nodes) = corners(&times_s, &nodes);
    }
    JerkControlledMotion::new(times_s, nodes).map_err(|error| {
        error
            .input_error()
            .cloned()
            .unwrap_or_else(|| InputError::new(Refusal::MotionInvalid, error.to_string(), HELP))
            .into()
    })
}

/// The rows of a motion at a constant rate between which the acceleration is not on one line, and both ends.
fn corners(times_s: &[f64], nodes: &[Vector3<f64>]) -> (Vec<f64>, Vec<Vector3<f64>>) {
    let largest = nodes.iter().map(Vector3::amax).fold(0.0, f64::max);
    let is_corner = |k: usize| {
        let part = (times_s[k] - times_s[k - 1]) / (times_s[k + 1] - times_s[k - 1]);
        let on_line = nodes[k - 1] * (1.0 - part) + nodes[k + 1] * part;
        (nodes[k] - on_line).amax() > STRAIGHT * largest
    };
    let last = nodes.len() - 1;
    let kept = (0..=last).filter(|&k| k == 0 || k == last || is_corner(k));
    kept.map(|k| (times_s[k], nodes[k])).unzip()
}

/// The content of each column: 0 the time, 1 to 3 an axis; `None` for an axis that the sensor does not have, or for what follows from the acceleration. And whether
/// there is the latter.
fn read_header(line: Line<'_>, delimiter: Delimiter, axes: usize) -> Checked<(Vec<Option<usize>>, bool)> {
    let needed = &NAMES[..=axes];
    let help = format!("the header is {}", needed.join(","));
    let (mut slots, mut is_dense) = (Vec::new(), false);
    let mut fields: Vec<_> = line.fields(delimiter).collect();
    if fields.len() > 1 && fields.last().is_some_and(|(_, field)| field.is_empty()) {
        fields.pop();
    }
    for (offset, field) in fields {
        let reject = |code: Refusal, message: String| {
            Err(InputError::new(code, message, help.clone())
                .at_line(line.number)
                .at_column(line.column(offset))
                .into())
        };
        let shown = shorten(field);
        if field.parse::<f64>().is_ok() {
            return reject(Refusal::HeaderMissing, format!("there is no header, the first field is {shown}"));
        }
        match NAMES.iter().position(|name| name.eq_ignore_ascii_case(field)) {
            Some(slot) if slots.contains(&Some(slot)) => {
                return reject(Refusal::ColumnRepeated, format!("column `{shown}` is there twice"));
            }
            Some(slot) => slots.push(Some(slot)),
            None if DENSE.iter().any(|name| name.eq_ignore_ascii_case(field)) => {
                is_dense = true;
                slots.push(None);
            }
            None => return reject(Refusal::HeaderMissing, format!("column `{shown}` is not known")),
        }
    }
    for slot in &mut slots {
        *slot = slot.filter(|slot| *slot <= axes);
    }
    let missing: Vec<&str> =
        (0..=axes).filter(|slot| !slots.contains(&Some(*slot))).map(|slot| NAMES[slot]).collect();
    if missing.is_empty() {
        return Ok((slots, is_dense));
    }
    let message = match missing.as_slice() {
        [one] => format!("column {one} is missing"),
        several => format!("columns {} are missing", several.join(", ")),
    };
    Err(InputError::new(Refusal::ColumnMissing, message, help).at_line(line.number).into())
}

fn read_row(line: Line<'_>, delimiter: Delimiter, slots: &[Option<usize>]) -> Checked<[f64; 4]> {
    let mut values = [0.0; 4];
    let (mut fields, mut last_is_empty) = (0, false);
    for (offset, field) in line.fields(delimiter) {
        if let Some(Some(slot)) = slots.get(fields).copied() {
            let reject = |message: &str, help: &str| {
                let what =
                    if slot == 0 { "the time".into() } else { format!("axis {}", Axis::ALL[slot - 1]) };
                Err(InputError::new(
                    Refusal::NumberMalformed,
                    format!("\"{}\" for {what} {message}", shorten(field)),
                    help,
                )
                .at_line(line.number)
                .at_column(line.column(offset))
                .into())
            };
            match field.parse::<f64>() {
                Err(_) => return reject("is not a number", "numbers look like 9.81 or 1e-3"),
                Ok(value) if value.abs() <= LARGEST => values[slot] = value,
                Ok(_) => return reject("is not a usable number", "times are in s, accelerations in m/s²"),
            }
        }
        fields += 1;
        last_is_empty = field.is_empty();
    }
    if fields == slots.len() || (fields == slots.len() + 1 && last_is_empty) {
        return Ok(values);
    }
    let message = format!("{fields} columns where the header has {}", slots.len());
    Err(InputError::new(
        Refusal::RowMalformed,
        message,
        "every node needs a time and an acceleration for each axis",
    )
    .at_line(line.number)
    .into())
}

pub(crate) fn shorten(field: &str) -> String {
    field.chars().take(40).collect::<String>().escape_debug().to_string()
}
