//! Splits the bytes of an MCAP file into raw records, and checks that the record lengths in its uncompressed chunks add up. Other content is not decoded.

use mcap::records::op;

/// Bytes of a record before its content: opcode and length.
pub(crate) const HEAD: usize = 1 + 8;

/// A record.
pub(crate) struct RawRecord<'a> {
    pub(crate) opcode: u8,
    /// Number of bytes that it states.
    pub(crate) length: u64,
    /// The bytes that are there.
    pub(crate) content: &'a [u8],
}

impl RawRecord<'_> {
    pub(crate) fn is_whole(&self) -> bool {
        self.content.len() as u64 == self.length
    }
}

/// The records from here on; the last one may not be whole.
pub(crate) fn raw_records(bytes: &[u8]) -> impl Iterator<Item = RawRecord<'_>> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        let (&[opcode, ref length @ ..], after) = rest.split_first_chunk::<HEAD>()?;
        let length = u64::from_le_bytes(*length);
        let there = usize::try_from(length).unwrap_or(usize::MAX).min(after.len());
        let (content, next) = after.split_at(there);
        rest = next;
        Some(RawRecord { opcode, length, content })
    })
}

/// Do the records of every uncompressed chunk end where it ends? `mcap::LinearReader` subtracts their lengths
/// from the chunk's without a check.
pub(crate) fn chunk_lengths_add_up(bytes: &[u8]) -> bool {
    raw_records(bytes).filter(|record| record.opcode == op::CHUNK).all(|chunk| chunk_ends(chunk.content))
}

fn chunk_ends(chunk: &[u8]) -> bool {
    // two times, size and checksum; the name of the compression; the length of the records
    let name = chunk.get(28..).and_then(<[u8]>::split_first_chunk::<4>);
    let Some(([0, 0, 0, 0], rest)) = name else { return true };
    let Some((length, rest)) = rest.split_first_chunk::<8>() else { return true };
    let length = u64::from_le_bytes(*length);
    let there = usize::try_from(length).unwrap_or(usize::MAX).min(rest.len());
    let mut left = length;
    for record in raw_records(&rest[..there]) {
        let Some(after) = left.checked_sub(HEAD as u64).and_then(|left| left.checked_sub(record.length))
        else {
            return false;
        };
        left = after;
    }
    // of a chunk that was cut off more is missing than the head of a record
    left == 0 || (there as u64) < length
}
