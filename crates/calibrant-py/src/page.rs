//! What all results come as: JSON, what was noticed, and the sheet as text and as a page.

use calibrant::diagnostic::Diagnostic;
use calibrant::report::Sheet;
use serde_json::json;

/// The text of the JSON file, diagnostics as JSON, the sheet as text, the sheet as HTML.
pub(crate) type Page = (String, String, String, String);

/// Columns of a sheet as text.
pub(crate) const WIDTH: usize = 100;

/// A result.
pub(crate) fn page(json: String, notes: &[Diagnostic], sheet: &Sheet<'_>) -> Page {
    (json, json!(notes).to_string(), sheet.text(WIDTH), sheet.html())
}
