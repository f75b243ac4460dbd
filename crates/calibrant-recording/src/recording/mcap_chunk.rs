//! The records in a chunk of an MCAP file, unpacked.

use std::borrow::Cow;
use std::io::Read;

/// Begins and ends a container.
pub(crate) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Why a container cannot be read.
#[derive(Debug)]
pub(crate) enum Broken {
    Compression(String),
    Content(&'static str),
}

/// What is wrong where bytes end too early.
pub(crate) const SHORT: Broken = Broken::Content("a record ends too early");

/// Numbers and texts, one after the other.
pub(crate) struct Fields<'a>(pub(crate) &'a [u8]);

impl<'a> Fields<'a> {
    pub(crate) fn bytes(&mut self, count: u64) -> Result<&'a [u8], Broken> {
        let parts = usize::try_from(count).ok().and_then(|count| self.0.split_at_checked(count));
        let (bytes, rest) = parts.ok_or(SHORT)?;
        self.0 = rest;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Broken> {
        let (array, rest) = self.0.split_first_chunk().ok_or(SHORT)?;
        self.0 = rest;
        Ok(*array)
    }

    pub(crate) fn u16(&mut self) -> Result<u16, Broken> {
        self.array().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, Broken> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Result<u64, Broken> {
        self.array().map(u64::from_le_bytes)
    }

    /// A text behind its length.
    pub(crate) fn text(&mut self) -> Result<&'a str, Broken> {
        let length = self.u32()?;
        let bytes = self.bytes(u64::from(length))?;
        str::from_utf8(bytes).map_err(|_| Broken::Content("a text is not UTF-8"))
    }
}

/// The records of a chunk, as bytes. Of a chunk that is not whole, those that are there.
pub(crate) fn records(chunk: &[u8], is_whole: bool, most: u64) -> Result<Cow<'_, [u8]>, Broken> {
    let mut fields = Fields(chunk);
    let (_start, _end, length, checksum) = (fields.u64()?, fields.u64()?, fields.u64()?, fields.u32()?);
    let (compression, packed_length) = (fields.text()?, fields.u64()?);
    let packed = if is_whole { fields.bytes(packed_length)? } else { fields.0 };
    if length > most {
        return Err(Broken::Content("a chunk states more bytes than a record may have"));
    }
    let records = match compression {
        "" => Cow::Borrowed(packed),
        // a decoder that cannot be made reads nothing
        "zstd" => unpacked(zstd::stream::read::Decoder::new(packed), length),
        "lz4" => unpacked(Ok(lz4_flex::frame::FrameDecoder::new(packed)), length),
        other => return Err(Broken::Compression(other.to_owned())),
    };
    if is_whole && records.len() as u64 != length {
        return Err(Broken::Content("a chunk has not the length that it states"));
    }
    if is_whole && checksum != 0 && crc32fast::hash(&records) != checksum {
        return Err(Broken::Content("the checksum of a chunk is not that of its records"));
    }
    Ok(records)
}

/// What can be unpacked, one byte more than the length at most.
pub(super) fn unpacked<'a>(decoder: std::io::Result<impl Read>, length: u64) -> Cow<'a, [u8]> {
    let mut records = Vec::new();
    // an error leaves what was unpacked before it, and so the length tells
    let _ = decoder.and_then(|decoder| decoder.take(length.saturating_add(1)).read_to_end(&mut records));
    Cow::Owned(records)
}
