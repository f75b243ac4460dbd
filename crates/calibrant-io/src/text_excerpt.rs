//! Errors that show their place in a text.

use calibrant_core::error::InputError;
use std::ops::Range;

/// Longest text that an excerpt holds.
const EXCERPT_BYTES: usize = 256 * 1024;

/// The error, at these bytes of the text.
pub(crate) fn error_at(text: &str, span: Range<usize>, error: InputError) -> InputError {
    let start = (0..=span.start.min(text.len())).rev().find(|&at| text.is_char_boundary(at));
    let before = &text[..start.unwrap_or(0)];
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    InputError {
        line: Some(1 + before.bytes().filter(|&byte| byte == b'\n').count()),
        column: Some(1 + before[line_start..].chars().count()),
        excerpt: (text.len() <= EXCERPT_BYTES)
            .then(|| (text.to_owned(), before.len()..span.end.clamp(before.len(), text.len()))),
        ..error
    }
}
