//! Errors that show their place in a text.

use calibrant_core::error::InputError;
use std::ops::Range;

/// Longest text that an excerpt holds.
const EXCERPT_BYTES: usize = 256 * 1024;

/// The error, at these bytes of the text. The excerpt has whole characters.
pub fn error_at(text: &str, span: Range<usize>, error: InputError) -> InputError {
    let is_boundary = |at: &usize| text.is_char_boundary(*at);
    let start = (0..=span.start.min(text.len())).rev().find(is_boundary).unwrap_or(0);
    let end = (span.end.clamp(start, text.len())..=text.len()).find(is_boundary).unwrap_or(start);
    let before = &text[..start];
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    InputError {
        line: Some(1 + before.bytes().filter(|&byte| byte == b'\n').count()),
        column: Some(1 + before[line_start..].chars().count()),
        excerpt: (text.len() <= EXCERPT_BYTES).then(|| (text.to_owned(), start..end)),
        ..error
    }
}
