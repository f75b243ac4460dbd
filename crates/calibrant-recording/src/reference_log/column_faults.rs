//! What is wrong with the columns of a log.

use crate::recording::{ColumnMeaning, imu_column};
use crate::text::decoding::{Checked, refuse};
use crate::text::similar_word::nearest;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal};

/// The names that a log may have, for errors.
pub(super) const EXAMPLES: &str = "name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] \
    of an experiment file; without a header a trajectory is t x y z qx qy qz qw";

/// The column of this name; in a file without a header its number.
pub(super) fn named(names: &[String], name: &str) -> Checked<usize> {
    if let Some(column) = names.iter().position(|known| known.trim() == name.trim()) {
        return Ok(column);
    }
    let near = nearest(name, names.iter().map(String::as_str));
    let hint = near.map_or(String::new(), |near| format!("is `{near}` meant? "));
    let help = format!("{hint}the file has {}", quoted(names, 20));
    refuse(
        Refusal::ColumnMissing,
        format!("[machine.log.columns] names the column `{name}`, which the file lacks"),
        help,
    )
}

/// An error where two columns have the same slot.
pub(super) fn check_repeated(
    slots: &[Option<usize>],
    slot: usize,
    column: usize,
    names: &[String],
) -> Checked<()> {
    match slots.iter().position(|taken| *taken == Some(slot)) {
        Some(other) => Err(repeated("same", &names[other], &names[column]).into()),
        None => Ok(()),
    }
}

pub(super) fn repeated(what: &str, one: &str, other: &str) -> InputError {
    InputError::new(
        Refusal::ColumnRepeated,
        format!("two columns hold the {what}: `{one}` and `{other}`"),
        "rename one of them in the file, or say which in [machine.log.columns]",
    )
}

/// Are there columns of an IMU? An orientation beside them may be its own estimate.
pub(super) fn has_readings(names: &[String]) -> bool {
    names.iter().any(|name| matches!(imu_column(name).meaning, ColumnMeaning::Reading(..)))
}

/// The error where no name is that of a joint or of a pose.
pub(super) fn nothing_to_read(names: &[String]) -> InputError {
    if has_readings(names) {
        return InputError::new(
            Refusal::FormatUnknown,
            "the columns are those of a recording of an IMU: there is no joint and no pose",
            EXAMPLES,
        );
    }
    for (what, was, of, other) in [
        ("joints", "they were", "target_q", "actual_q"),
        ("tool", "it was", "target_TCP_pose", "actual_TCP_pose"),
    ] {
        if names.iter().any(|name| name.starts_with(&format!("{of}_"))) {
            return InputError::new(
                Refusal::ColumnMissing,
                format!("the log holds where the {what} should have been ({of}), not where {was}"),
                format!("record {other}, too"),
            );
        }
    }
    let message =
        format!("no column is known to be of a joint or of a pose; the columns are {}", quoted(names, 20));
    InputError::new(Refusal::ColumnMissing, message, EXAMPLES)
}

/// The error about a text of numbers alone.
pub(super) fn without_header(columns: usize) -> InputError {
    let message = format!("{columns} column{} without a header", if columns == 1 { "" } else { "s" });
    InputError::new(Refusal::HeaderMissing, message, EXAMPLES)
}
