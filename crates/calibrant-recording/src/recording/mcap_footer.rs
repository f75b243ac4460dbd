//! The end of an MCAP container. A recorder that was killed, or a copy that broke off, leaves none.
//!
//! A whole container ends with a record `DataEnd` below the messages, an index, a record `Footer` and the magic bytes once more.

use super::mcap_chunk::MAGIC;
use super::mcap_records::{HEAD, op, raw_records};
use calibrant_core::diagnostic::reader::{BytesUnread, FileUnfinished};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{InputError, Refusal};

/// A container without its end.
#[derive(Clone)]
pub(crate) struct Cut {
    /// Number of bytes that are there.
    length: usize,
    /// Opcode and place of the record that is not whole; `None` where the file ends between two.
    within: Option<(u8, usize)>,
    /// Is everything there but the index?
    is_after_data: bool,
}

/// The warning about what follows the end of a container: a second one, or other bytes.
pub(crate) fn unread_after(bytes: &[u8]) -> Option<Diagnostic> {
    let rest = bytes.get(end(bytes).ok()?..)?;
    let is_bag = rest.starts_with(MAGIC);
    (!rest.is_empty()).then(|| BytesUnread { bytes: rest.len(), is_bag }.into())
}

/// The end of a whole container, or its missing part.
fn end(bytes: &[u8]) -> Result<usize, Cut> {
    let (mut at, mut is_after_data) = (MAGIC.len(), false);
    for record in raw_records(bytes.get(at..).unwrap_or_default()) {
        if !record.is_whole() {
            return Err(Cut { length: bytes.len(), within: Some((record.opcode, at)), is_after_data });
        }
        at += HEAD + record.content.len();
        is_after_data |= record.opcode == op::DATA_END;
        if record.opcode == op::FOOTER && bytes[at..].starts_with(MAGIC) {
            return Ok(at + MAGIC.len());
        }
    }
    Err(Cut { length: bytes.len(), within: None, is_after_data })
}

impl Cut {
    /// The missing part of a container; `None` where it is whole.
    pub(crate) fn of(bytes: &[u8]) -> Option<Self> {
        end(bytes).err()
    }

    /// The warning where messages could be read: their number, and their duration, s.
    pub(crate) fn finding(&self, messages: usize, duration_s: f64) -> Diagnostic {
        let (cut, is_after_data) = (Phrase(self.sentence()), self.is_after_data);
        FileUnfinished { cut, is_after_data, messages, duration_s }.into()
    }

    /// The error where none could be read.
    pub(crate) fn input_error(&self, whose: &str) -> InputError {
        let message = format!("{}, before any message of {whose}", self.sentence());
        InputError::new(
            Refusal::FileDamaged,
            message,
            "is it a whole copy? was the recorder stopped before it had written anything?",
        )
    }

    fn sentence(&self) -> String {
        let length = self.length;
        match self.within {
            Some((opcode, at)) => {
                format!(
                    "the bag was cut off at byte {length}, within the {} that begins at byte {at}",
                    name(opcode)
                )
            }
            None => format!("the bag was cut off: it ends at byte {length}, without an end of its container"),
        }
    }
}

fn name(opcode: u8) -> &'static str {
    match opcode {
        op::MESSAGE => "message",
        op::CHUNK => "chunk of messages",
        _ => "record",
    }
}
