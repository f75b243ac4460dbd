//! The sizes of recordings: the largest file, and an estimate of the number of rows.

/// Largest recording, bytes.
pub(crate) const LARGEST: u64 = 8 << 30;

/// Fewest bytes of a row: `0 0 0 0` and a line end. It limits the memory that is reserved ahead.
const LEAST_ROW_BYTES: usize = 8;

/// About how many rows a text of this length has, from the lines in the middle of this part of it.
pub(crate) fn estimated_rows(text: &str, first: &str, length: usize) -> usize {
    /// Bytes from which the number of rows is estimated.
    const PROBE: usize = 4096;
    let middle = text.len() / 2;
    let probe = &text.as_bytes()[middle..text.len().min(middle + PROBE)];
    let ends = probe.iter().filter(|&&byte| byte == b'\n').count();
    let row = if ends > 1 { probe.len() / ends } else { first.len() };
    length / row.max(LEAST_ROW_BYTES) + 16
}
