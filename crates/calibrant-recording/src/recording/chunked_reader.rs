//! Reads a text file in pieces of whole lines: however long a recording is, its text is never in memory at
//! once.

use super::bag_kind::BagKind;
use super::size::LARGEST;
use crate::files::checksum::hex;
use crate::text::decoding::{self, Checked, refuse};
use calibrant_core::error::Refusal;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes that are read at a time: few enough to be still in the cache when they are parsed.
const PIECE: usize = 128 << 10;

/// Bytes that stay for the next piece: the lines above show whether the last line was cut off.
const HELD_BACK: usize = 16 << 10;
/// Largest stated length of a file that is trusted, bytes.
const TRUSTED: u64 = 64 << 20;

/// Refuses a database whose latest rows are in a file beside it still.
fn check_merged(path: &Path) -> Checked<()> {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    if std::fs::metadata(&log).map_or(0, |metadata| metadata.len()) == 0 {
        return Ok(());
    }
    let log = log.to_string_lossy();
    let message = format!("its latest messages are in {log} beside it: its recorder was killed");
    let file = path.display();
    refuse(
        Refusal::FileUnreadable,
        message,
        format!(
            "put them into it: sqlite3 {file} 'PRAGMA wal_checkpoint(TRUNCATE)'; or take {log} away to do without them"
        ),
    )
}

/// The beginning of a file, and its remainder.
pub(crate) struct FileBeginning {
    /// Its first lines. Everything where the file is short, or is no text in lines.
    pub(crate) bytes: Vec<u8>,
    pub(crate) rest: Option<Pieces>,
    is_binary: bool,
}

impl FileBeginning {
    /// Files that begin as `is_binary` says are read whole. No other file may have a NUL byte.
    pub(crate) fn read(path: &Path, is_binary: impl Fn(&[u8]) -> bool) -> Checked<Self> {
        let file = decoding::open_file(path, "the recording")?;
        let length = file.metadata().map_or(0, |metadata| metadata.len()).min(TRUSTED);
        let mut pieces = Pieces { file, length, hash: Sha256::new(), read: 0, ended: false, cut: Vec::new() };
        let mut bytes = Vec::new();
        pieces.fill(&mut bytes)?;
        let is_binary = is_binary(&bytes);
        if BagKind::of(&bytes) == Some(BagKind::Db3) {
            check_merged(path)?;
        }
        let whole = pieces.ended || is_binary || !pieces.cut_off(&mut bytes);
        let mut beginning = Self { bytes, rest: Some(pieces), is_binary };
        if whole {
            beginning.read_on()?;
        }
        Ok(beginning)
    }

    /// Reads the rest of the file too.
    pub(crate) fn read_on(&mut self) -> Checked<()> {
        let Some(mut pieces) = self.rest.take() else { return Ok(()) };
        self.bytes.append(&mut pieces.cut);
        self.bytes.reserve(pieces.length.saturating_sub(pieces.read) as usize);
        let mut examined = 0;
        loop {
            // a device or a disk image must not fill the memory
            if !self.is_binary && memchr::memchr(0, &self.bytes[examined..]).is_some() {
                decoding::as_text(&self.bytes)?;
            }
            if pieces.ended {
                return Ok(());
            }
            examined = self.bytes.len();
            pieces.fill(&mut self.bytes)?;
        }
    }

    /// Length of the whole file, bytes, as far as it is known.
    pub(crate) fn length(&self) -> usize {
        self.rest.as_ref().map_or(0, |pieces| pieces.length as usize).max(self.bytes.len())
    }
}

/// The remainder after the beginning of a file.
pub(crate) struct Pieces {
    file: File,
    /// The length by the file system, as far as that is trusted.
    length: u64,
    hash: Sha256,
    /// Bytes so far.
    read: u64,
    ended: bool,
    /// The beginning of the next piece.
    cut: Vec<u8>,
}

/// Some lines of a file.
pub(crate) struct Piece {
    bytes: Vec<u8>,
    /// Its first byte in the file.
    offset: u64,
}

impl Pieces {
    /// The next lines; `None` at the end of the file. `spare` is the memory of a piece that is no longer
    /// needed.
    pub(crate) fn next(&mut self, spare: Option<Piece>) -> Checked<Option<Piece>> {
        let mut bytes = spare.map_or_else(Vec::new, |piece| piece.bytes);
        bytes.clear();
        bytes.append(&mut self.cut);
        let offset = self.read - bytes.len() as u64;
        while !self.ended {
            self.fill(&mut bytes)?;
            if !self.ended && self.cut_off(&mut bytes) {
                break;
            }
        }
        Ok((!bytes.is_empty()).then_some(Piece { bytes, offset }))
    }

    /// SHA-256 of the file, which has been read to its end.
    pub(crate) fn sha256(self) -> String {
        hex(self.hash)
    }

    fn fill(&mut self, bytes: &mut Vec<u8>) -> Checked<()> {
        let before = bytes.len();
        bytes.reserve(PIECE + 1);
        let read = self.file.by_ref().take(PIECE as u64).read_to_end(bytes);
        read.map_err(|error| decoding::unreadable("the recording", &error))?;
        self.hash.update(&bytes[before..]);
        self.read += (bytes.len() - before) as u64;
        self.ended = bytes.len() - before < PIECE;
        if self.read > LARGEST {
            return Err(decoding::too_large("the recording", LARGEST).into());
        }
        Ok(())
    }

    /// Moves some lines to the next piece, the last of them cut in two. Returns whether lines remain.
    fn cut_off(&mut self, bytes: &mut Vec<u8>) -> bool {
        let Some(last) = memchr::memrchr(b'\n', &bytes[..bytes.len().saturating_sub(HELD_BACK)]) else {
            return false;
        };
        self.cut.extend_from_slice(&bytes[last + 1..]);
        bytes.truncate(last + 1);
        true
    }
}

impl Piece {
    /// Its text, which follows this number of lines.
    pub(crate) fn text(&self, before: usize) -> Checked<&str> {
        decoding::as_text_at(&self.bytes, self.offset, before)
    }
}
