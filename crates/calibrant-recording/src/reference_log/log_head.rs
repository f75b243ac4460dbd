//! The head of a text and its columns: an export of a tracker, or a table with or without a header.

use super::options::ReferenceLogOptions;
use super::text_columns::TextColumns;
use super::tracker_export::Export;
use super::{motive, qualisys, vicon};
use crate::recording::text_header::Head;
use crate::text::decoding::Checked;

/// The head and the columns of a text.
pub(super) fn head_and_columns<'t>(
    text: &'t str,
    options: &ReferenceLogOptions,
) -> Checked<(Head<'t>, TextColumns)> {
    if let Some(export) = export(text) {
        return export.columns(options);
    }
    let head = Head::find(text)?;
    let columns = TextColumns::find(&head, options)?;
    Ok((head, columns))
}

/// The export of a tracker, where the text is one.
pub(super) fn export(text: &str) -> Option<Export<'_>> {
    motive::find(text).or_else(|| vicon::find(text)).or_else(|| qualisys::find(text))
}
