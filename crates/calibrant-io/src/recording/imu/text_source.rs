//! The source of a text: bytes in memory, or a file that is read in pieces.

use super::column_values::{SampleReader, Samples};
use super::text_header::Head;
use super::{FileFormat, ImuFile};
use crate::delimited_text::{Line, Lines};
use crate::recording::checksum::hex_sha256;
use crate::recording::chunked_reader::{FileBeginning, Pieces};
use crate::recording::row_parser::Layout;
use crate::recording::size::estimated_rows;
use crate::text_decoding::{self, Checked};
use std::path::Path;

/// A text, or its first lines and its remainder.
pub(super) struct Source<'s> {
    pub(super) text: &'s str,
    /// Length of all of it, bytes, as far as it is known.
    length: usize,
    rest: Option<&'s mut Pieces>,
}

/// The beginning of a file; all of it where that is of a binary format.
pub(super) fn beginning(path: &Path) -> Checked<FileBeginning> {
    FileBeginning::read(path, |bytes| FileFormat::of_magic(bytes).is_some())
}

/// Reads a text from its bytes.
pub(super) fn of_bytes(
    bytes: &[u8],
    read: impl Fn(Source<'_>) -> Checked<ImuFile> + Sync,
) -> Checked<ImuFile> {
    let text = text_decoding::as_text(bytes)?;
    let source = || Source { text, length: text.len(), rest: None };
    let (file, sha256) = rayon::join(|| read(source()), || hex_sha256(bytes));
    Ok(ImuFile { sha256: vec![sha256], ..file? })
}

/// Continues to read a text file from its beginning: in pieces, or at once where the beginning does not hold
/// its head.
pub(super) fn of_file(
    mut beginning: FileBeginning,
    read: impl Fn(Source<'_>) -> Checked<ImuFile> + Sync,
) -> Checked<ImuFile> {
    let length = beginning.length();
    if let Some(rest) = &mut beginning.rest {
        let text = text_decoding::as_text(&beginning.bytes)?;
        if Head::find(text).is_ok() {
            let file = read(Source { text, length, rest: Some(rest) })?;
            let sha256 = beginning.rest.into_iter().map(Pieces::sha256).collect();
            return Ok(ImuFile { sha256, ..file });
        }
        beginning.read_on()?;
    }
    of_bytes(&beginning.bytes, read)
}

impl Source<'_> {
    /// Reads the rows below a head.
    pub(super) fn samples(self, layout: &Layout, head: Head<'_>) -> Checked<Samples> {
        let first = head.first_row.map_or("", |line| line.text);
        let mut reader = SampleReader::new(layout, estimated_rows(self.text, first, self.length));
        let lines = head.first_row.into_iter().chain(head.rest);
        match self.rest {
            None => reader.take(lines, self.text)?,
            Some(rest) => in_pieces(&mut reader, lines, self.text, rest)?,
        }
        reader.finish()
    }
}

/// Parses lines, and those that follow them in a file. Meanwhile the next are read.
fn in_pieces<'t>(
    reader: &mut SampleReader<'_>,
    first: impl Iterator<Item = Line<'t>> + Send,
    text: &str,
    rest: &mut Pieces,
) -> Checked<()> {
    let (taken, mut next) = rayon::join(|| reader.take(first, text), || rest.next(None));
    taken?;
    let mut spare = None;
    while let Some(piece) = next? {
        let (before, used) = (reader.last_line().unwrap_or(0), spare.take());
        let take = || {
            let text = piece.text(before)?;
            reader.take(Lines::after(before, text), text)
        };
        let (taken, following) = rayon::join(take, || rest.next(used));
        taken?;
        (next, spare) = (following, Some(piece));
    }
    Ok(())
}
