//! Makes a log of the values of a file: times in seconds, poses or positions of joints, and findings.

use super::angles::unwrap_angles;
use super::blank_poses::blank_placeholders;
use super::body_speed::body_too_fast;
use super::content::Content;
use super::file::ReferenceLogFile;
use super::format::ReferenceFormat;
use super::held_rows::leave_out_held;
use super::orientation_form::OrientationForm;
use super::quaternion::ROUNDED;
use super::rows::Rows;
use crate::recording::clock_column::{ClockColumn, backwards};
use crate::recording::line_map::LineMap;
use crate::recording::tally::Tally;
use crate::recording::time_order::{is_clock_out_of_order, late, sorted_rows};
use crate::recording::{TimeUnit, recording_quality};
use crate::text::decoding::{Checked, refuse};
use crate::trajectory::{between_knots, spline_through};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::QuaternionNorm;
use calibrant_core::diagnostic::reader::{LineTruncated, MissingValue, RowsSorted, ValuesMissing};
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::rate_hz;
use calibrant_machine::log::{JointLog, PoseLog, ReferenceLog};
use nalgebra::Vector3;

/// Largest plausible value.
const LARGEST: f64 = 1e12;

/// Makes the log. The file's SHA-256 is still missing.
pub(super) fn assemble(
    format: ReferenceFormat,
    content: Content,
    (time_name, time_unit): (&str, Option<TimeUnit>),
    mut rows: Rows,
    mut findings: Vec<Diagnostic>,
) -> Checked<ReferenceLogFile> {
    let number_of_rows = rows.times.len();
    if number_of_rows == 0 {
        return Err(short("there is no row of numbers".into(), &rows).into());
    }
    findings.extend(put_in_order(&mut rows, content.width(), time_name));
    let section = "machine.log.columns";
    let clock =
        ClockColumn { name: time_name, unit: time_unit, wraps_at: None, origin: rows.origin, section };
    let clock = clock.seconds(std::mem::take(&mut rows.times), &rows.lines, &mut findings)?;
    let mut rows = Rows { times: clock.times_s, ..rows };
    let kept = with_times(&rows, &mut findings)?;
    if let Content::Poses(form) = content {
        findings.extend(blank_placeholders(form, &kept, &mut rows));
    }
    let width = content.width();
    let value = |row: usize| &rows.values[row * width..][..width];
    for &row in &kept {
        if let Some(out) = value(row).iter().find(|value| value.abs() > LARGEST) {
            let message = format!("the value {out:e} is out of range");
            let input_error =
                InputError::new(Refusal::ValueOutOfRange, message, "is the unit right? is the file damaged?");
            return Err(at(input_error, &rows, row).into());
        }
    }
    let times_s: Vec<f64> = kept.iter().map(|&row| rows.times[row]).collect();
    let (mut log, turns) = match content {
        Content::Poses(form) => {
            (ReferenceLog::Poses(poses(form, times_s, &kept, &rows, &mut findings)?), Vec::new())
        }
        Content::Joints { names, turns, has_velocities, derivatives } => {
            let joints = names.len();
            if derivatives == 2 {
                let all: Vec<f64> = kept.iter().flat_map(|&row| value(row)).copied().collect();
                if let Some(trajectory) = spline_through(&times_s, &all, joints) {
                    return Ok(ReferenceLogFile {
                        log: ReferenceLog::Joints(between_knots(&trajectory, names)),
                        turns,
                        format,
                        findings,
                        rows: number_of_rows,
                        sha256: String::new(),
                        counted_from_ns: clock.counted_from_ns,
                        knot_step_s: Some(trajectory.knots.step_s),
                        trajectory: Some(trajectory),
                    });
                }
            }
            let positions = kept.iter().flat_map(|&row| &value(row)[..joints]).copied().collect();
            let velocities = has_velocities
                .then(|| kept.iter().flat_map(|&row| &value(row)[joints..2 * joints]).copied().collect());
            let mut log = JointLog { names, times_s, positions, velocities };
            findings.extend(unwrap_angles(&mut log, &turns));
            (ReferenceLog::Joints(log), turns)
        }
    };
    check_seen(&log, &rows)?;
    findings.extend(leave_out_held(&mut log));
    if let ReferenceLog::Poses(poses) = &log {
        findings.extend(body_too_fast(poses));
    }
    if rows.truncated.is_some() {
        findings.push(Diagnostic::from(LineTruncated {}).at_line(rows.truncated));
    }
    sampling(&kept, &rows, &mut findings);
    Ok(ReferenceLogFile {
        log,
        turns,
        format,
        findings,
        rows: number_of_rows,
        sha256: String::new(),
        counted_from_ns: clock.counted_from_ns,
        knot_step_s: None,
        trajectory: None,
    })
}

/// Puts rows in the order of their times, where these are those of one clock, but not in order.
fn put_in_order(rows: &mut Rows, width: usize, clock: &str) -> Option<Diagnostic> {
    let known: Vec<f64> = rows.times.iter().copied().filter(|t| !t.is_nan()).collect();
    if !is_clock_out_of_order(&known) {
        return None;
    }
    let order = sorted_rows(&rows.times);
    rows.times = order.iter().map(|&row| rows.times[row]).collect();
    rows.values = order.iter().flat_map(|&row| &rows.values[row * width..][..width]).copied().collect();
    rows.lines = rows.lines.of(&order);
    Some(RowsSorted { rows: late(known.iter().copied()), of: known.len(), by: format!("`{clock}`") }.into())
}

/// The rows that have a time; an error where a time goes backwards, or where all are the same.
fn with_times(rows: &Rows, findings: &mut Vec<Diagnostic>) -> Checked<Vec<usize>> {
    let mut untimed = Tally::default();
    let mut kept: Vec<usize> = Vec::with_capacity(rows.times.len());
    for (row, &t) in rows.times.iter().enumerate() {
        if t.is_nan() {
            untimed.add(rows.lines.line(row));
            continue;
        }
        kept.push(row);
    }
    let times: Vec<f64> = kept.iter().map(|&row| rows.times[row]).collect();
    if let Some(k) = (1..times.len()).find(|&k| times[k] < times[k - 1]) {
        let first = (times[k - 1], times[k]);
        return Err(at(backwards(first, times.iter().copied()), rows, kept[k]).into());
    }
    untimed.report(findings, None, |count| ValuesMissing { missing: MissingValue::Time, count });
    match (kept.first(), kept.last()) {
        (Some(first), Some(last)) if first != last && rows.times[*first] == rows.times[*last] => {
            let message = format!("the time is {:?} s in every row", rows.times[*first]);
            refuse(Refusal::TimesNotIncreasing, message, "did the clock stand still?")
        }
        (Some(first), Some(last)) if first != last => Ok(kept),
        _ if rows.times.len() == 1 => Err(short("there is only one row".into(), rows).into()),
        (Some(_), _) => Err(short("only one row has a time".into(), rows).into()),
        _ => Err(short("no row has a time".into(), rows).into()),
    }
}

fn poses(
    form: OrientationForm,
    times_s: Vec<f64>,
    kept: &[usize],
    rows: &Rows,
    findings: &mut Vec<Diagnostic>,
) -> Checked<PoseLog> {
    let mut positions_m = Vec::with_capacity(kept.len());
    let mut world_from_body = Vec::with_capacity(kept.len());
    let mut farthest = 0.0_f64;
    let width = 3 + form.width();
    for &row in kept {
        let values = &rows.values[row * width..][..width];
        let position = Vector3::new(values[0], values[1], values[2]);
        positions_m.push(position.iter().all(|value| !value.is_nan()).then_some(position));
        let found = form.orientation(&values[3..]).map_err(|[message, help]| {
            at(InputError::new(Refusal::ValueInvalid, message, help), rows, row)
        })?;
        farthest = found.map_or(farthest, |(_, off)| farthest.max(off));
        world_from_body.push(found.map(|(orientation, _)| orientation));
    }
    if farthest > ROUNDED {
        findings.push(QuaternionNorm { off: farthest }.into());
    }
    Ok(PoseLog { times_s, positions_m, world_from_body })
}

/// An error where fewer than two rows hold anything, or a joint has no position.
fn check_seen(log: &ReferenceLog, rows: &Rows) -> Checked<()> {
    let seen = match log {
        ReferenceLog::Poses(log) => {
            let seen = log.positions_m.iter().zip(&log.world_from_body);
            seen.filter(|(position, orientation)| position.is_some() || orientation.is_some()).count()
        }
        ReferenceLog::Joints(log) => {
            let has_position = |joint: usize| (0..log.times_s.len()).any(|k| !log.row(k)[joint].is_nan());
            if let Some(joint) = (0..log.names.len()).find(|&joint| !has_position(joint)) {
                let message = format!("the joint `{}` has no position in any row", log.names[joint]);
                return refuse(Refusal::RecordingShort, message, "was it recorded? leave its column out");
            }
            (0..log.times_s.len()).filter(|&k| log.row(k).iter().any(|value| !value.is_nan())).count()
        }
    };
    if seen >= 2 {
        return Ok(());
    }
    let what = if matches!(log, ReferenceLog::Poses(_)) { "a pose" } else { "a position" };
    let message = match seen {
        0 => format!("no row has {what}: every value is NaN, or a placeholder"),
        _ => format!("only one row has {what}"),
    };
    Err(short(message, rows).into())
}

/// Looks for gaps and irregular sampling.
fn sampling(kept: &[usize], rows: &Rows, findings: &mut Vec<Diagnostic>) {
    let (mut times_s, mut lines) = (Vec::with_capacity(kept.len()), LineMap::default());
    for &row in kept {
        if times_s.last() != Some(&rows.times[row]) {
            if let Some(line) = rows.lines.line(row) {
                lines.push(times_s.len(), line);
            }
            times_s.push(rows.times[row]);
        }
    }
    let rate_hz = rate_hz(&times_s);
    recording_quality::clock(rate_hz, findings);
    recording_quality::sampling(&times_s, rate_hz, &lines, findings);
}

/// The error at the line of a row, or about a message where there are no lines.
fn at(input_error: InputError, rows: &Rows, row: usize) -> InputError {
    match rows.lines.line(row) {
        Some(line) => input_error.at_line(line),
        None => {
            let message = format!("message {}: {}", row + 1, input_error.message);
            InputError { message, ..input_error }
        }
    }
}

fn short(message: String, rows: &Rows) -> InputError {
    let input_error = InputError::new(
        Refusal::RecordingShort,
        message,
        "a log needs two rows with a time and a position at least",
    );
    match rows.last_line {
        Some(line) => input_error.at_line(line),
        None => input_error,
    }
}
