//! Splits the bytes of an MCAP file, or of a chunk, into records. Their content is not decoded.

/// Opcodes of records.
pub(crate) mod op {
    pub(crate) const FOOTER: u8 = 2;
    pub(crate) const SCHEMA: u8 = 3;
    pub(crate) const CHANNEL: u8 = 4;
    pub(crate) const MESSAGE: u8 = 5;
    pub(crate) const CHUNK: u8 = 6;
    pub(crate) const DATA_END: u8 = 15;
}

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
