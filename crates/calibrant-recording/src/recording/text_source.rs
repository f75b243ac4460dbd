//! The source of a text: bytes in memory, or a file that is read in pieces.

use super::chunked_reader::{FileBeginning, Pieces};
use super::size::estimated_rows;
use super::text_header::Head;
use crate::files::checksum::hex_sha256;
use crate::text::decoding::{self, Checked};
use crate::text::delimited::{Line, Lines};

/// A text, or its first lines and its remainder.
pub(crate) struct Source<'s> {
    pub(crate) text: &'s str,
    /// Length of all of it, bytes, as far as it is known.
    length: usize,
    rest: Option<&'s mut Pieces>,
}

/// What takes the rows of a text.
pub(crate) trait RowTaker: Send {
    /// Takes some more lines: further lines of this text or its last ones.
    fn take<'t>(&mut self, lines: impl Iterator<Item = Line<'t>>, text: &str) -> Checked<()>;

    /// Number of the last line so far.
    fn last_line(&self) -> Option<usize>;
}

/// Reads a text from its bytes; returns its SHA-256 as well.
pub(crate) fn of_bytes<T: Send>(
    bytes: &[u8],
    read: impl Fn(Source<'_>) -> Checked<T> + Sync,
) -> Checked<(T, String)> {
    let text = decoding::as_text(bytes)?;
    let source = || Source { text, length: text.len(), rest: None };
    let (file, sha256) = rayon::join(|| read(source()), || hex_sha256(bytes));
    Ok((file?, sha256))
}

/// Continues to read a text file from its beginning: in pieces, or at once where the beginning does not hold
/// its head. Returns its SHA-256 as well.
pub(crate) fn of_file<T: Send>(
    mut beginning: FileBeginning,
    read: impl Fn(Source<'_>) -> Checked<T> + Sync,
) -> Checked<(T, String)> {
    let length = beginning.length();
    if let Some(mut rest) = beginning.rest.take() {
        let text = decoding::as_text(&beginning.bytes)?;
        if Head::find(text).is_ok() {
            let file = read(Source { text, length, rest: Some(&mut rest) })?;
            return Ok((file, rest.sha256()));
        }
        beginning.rest = Some(rest);
        beginning.read_on()?;
    }
    of_bytes(&beginning.bytes, read)
}

impl Source<'_> {
    /// About how many rows there are below a head.
    pub(crate) fn estimated_rows(&self, head: &Head<'_>) -> usize {
        estimated_rows(self.text, head.first_row.map_or("", |line| line.text), self.length)
    }

    /// Reads the rows below a head.
    pub(crate) fn read_rows(self, head: Head<'_>, taker: &mut impl RowTaker) -> Checked<()> {
        let lines = head.first_row.into_iter().chain(head.rest);
        match self.rest {
            None => taker.take(lines, self.text),
            Some(rest) => in_pieces(taker, lines, self.text, rest),
        }
    }
}

/// Parses lines, and those that follow them in a file. Meanwhile the next are read.
fn in_pieces<'t>(
    taker: &mut impl RowTaker,
    first: impl Iterator<Item = Line<'t>> + Send,
    text: &str,
    rest: &mut Pieces,
) -> Checked<()> {
    let (taken, mut next) = rayon::join(|| taker.take(first, text), || rest.next(None));
    taken?;
    let mut spare = None;
    while let Some(piece) = next? {
        let (before, used) = (taker.last_line().unwrap_or(0), spare.take());
        let take = || {
            let text = piece.text(before)?;
            taker.take(Lines::after(before, text), text)
        };
        let (taken, following) = rayon::join(take, || rest.next(used));
        taken?;
        (next, spare) = (following, Some(piece));
    }
    Ok(())
}
