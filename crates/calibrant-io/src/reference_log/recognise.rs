//! Distinguishes a log of a motion from other files.

use super::format::ReferenceFormat;
use super::options::ReferenceLogOptions;
use super::quaternion::orientation;
use super::read::{is_bag, read_reference_log};
use super::text_columns::{TextColumns, first_row};
use crate::recording::chunked_reader::FileBeginning;
use crate::recording::text_header::Head;
use crate::text::decoding;
use std::path::Path;

/// Is a file a log of joints or poses, by its beginning? Its rows may still be broken.
#[must_use]
pub fn is_reference_log(path: &Path, options: &ReferenceLogOptions) -> bool {
    let Ok(beginning) = FileBeginning::read(path, is_bag) else { return false };
    if is_bag(&beginning.bytes) {
        return read_reference_log(path, options).is_ok();
    }
    let Ok(text) = decoding::as_text(&beginning.bytes) else { return false };
    let Ok(head) = Head::find(text) else { return false };
    let Ok(columns) = TextColumns::find(&head, options) else { return false };
    // eight columns without a header may be anything
    columns.format != ReferenceFormat::Tum || !columns.names.is_empty() || has_orientation(&first_row(&head))
}

/// Are the last four of the fields of a row a quaternion?
fn has_orientation(row: &[&str]) -> bool {
    let value = |field: usize| row.get(field).and_then(|field| field.parse().ok()).unwrap_or(0.0);
    orientation([value(7), value(4), value(5), value(6)]).is_ok()
}
