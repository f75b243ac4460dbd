//! Distinguishes a log of a motion from other files.

use super::format::ReferenceFormat;
use super::log_head::{export, head_and_columns};
use super::options::ReferenceLogOptions;
use super::orientation_form::OrientationForm;
use super::read::{is_bag, read_reference_log};
use super::text_columns::first_row;
use crate::recording::chunked_reader::FileBeginning;
use crate::text::decoding;
use calibrant_core::error::{Error, Refusal};
use std::path::Path;

/// Is a file a log of joints or poses, by its beginning? Its rows may still be broken.
#[must_use]
pub fn is_reference_log(path: &Path, options: &ReferenceLogOptions) -> bool {
    let Ok(beginning) = FileBeginning::read(path, is_bag) else { return false };
    if is_bag(&beginning.bytes) {
        return read_reference_log(path, options).is_ok();
    }
    decoding::as_text(&beginning.bytes).is_ok_and(|text| has_log(text, options))
}

/// Is a text that begins so a log?
pub(super) fn has_log(text: &str, options: &ReferenceLogOptions) -> bool {
    // which body, and what its angles are, may still be asked
    if export(text).is_some() {
        return true;
    }
    let Ok((head, columns)) = head_and_columns(text, options) else { return false };
    // eight columns without a header may be anything
    columns.format != ReferenceFormat::Tum || !columns.names.is_empty() || has_orientation(&first_row(&head))
}

/// Why a bag that has a motion gives no log of it. `None` for a bag without a motion, and for other files.
#[must_use]
pub fn unusable_log(path: &Path, options: &ReferenceLogOptions) -> Option<Error> {
    let beginning = FileBeginning::read(path, is_bag).ok()?;
    match read_reference_log(path, options) {
        Err(Error::Recording(why)) if is_bag(&beginning.bytes) => {
            let is_without = why.code == Refusal::TopicUnknown && why.answers.is_empty();
            (!is_without).then(|| Error::recording(*why))
        }
        _ => None,
    }
}

/// Are the last four of the fields of a row a quaternion?
fn has_orientation(row: &[&str]) -> bool {
    let value = |field: usize| row.get(field).and_then(|field| field.parse().ok()).unwrap_or(0.0);
    OrientationForm::QuaternionXyzw.orientation(&[4, 5, 6, 7].map(value)).is_ok()
}
