//! Reads the messages of bags in MCAP containers.

use super::bag::{Bag, Connection, MessageType};
use super::mcap_chunk::{Broken, Fields, MAGIC, SHORT, records};
use super::mcap_footer::{Cut, unread_after};
use super::mcap_records::{HEAD, RawRecord, op, raw_records};
use crate::text::decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use std::collections::BTreeMap;

/// A chunk may have this many bytes, even where the compressed file has fewer: a map that was latched.
const LARGEST_CHUNK: usize = 1 << 28;

/// What a container says of a channel.
struct ChannelRecord<'a> {
    id: u16,
    schema_id: u16,
    topic: &'a str,
    message_encoding: &'a str,
}

impl<'a> ChannelRecord<'a> {
    fn read(mut fields: Fields<'a>) -> Result<Self, Broken> {
        let (id, schema_id) = (fields.u16()?, fields.u16()?);
        let (topic, message_encoding) = (fields.text()?, fields.text()?);
        let length = fields.u32()?;
        // pairs of texts that nothing here needs
        let mut pairs = Fields(fields.bytes(length.into())?);
        while !pairs.0.is_empty() {
            pairs.text()?;
        }
        Ok(Self { id, schema_id, topic, message_encoding })
    }
}

/// The messages of these types.
pub(super) fn read<'t, M>(bytes: &[u8], types: &'t [MessageType<M>]) -> Checked<Bag<'t, M>> {
    let Some(content) = bytes.strip_prefix(MAGIC) else {
        return Err(damaged(&Broken::Content("it does not begin as one")).into());
    };
    let (schemas, channels) = Default::default();
    let mut reader = Reader { bag: Bag::new(types), schemas, channels };
    (reader.bag.cut, reader.bag.unread) = (Cut::of(bytes), unread_after(bytes));
    let most = bytes.len().max(LARGEST_CHUNK) as u64;
    for record in raw_records(content) {
        match record.opcode {
            op::FOOTER => break,
            op::CHUNK => reader.take_chunk(&record, most)?,
            _ if !record.is_whole() => (),
            _ => reader.take(record.opcode, record.content)?,
        }
    }
    Ok(reader.bag)
}

/// A container while it is read.
struct Reader<'t, M> {
    bag: Bag<'t, M>,
    /// Name of each schema.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Connection<'t, M>>,
}

impl<M> Reader<'_, M> {
    /// Takes the records of a chunk. The last one of the file may have been cut off.
    fn take_chunk(&mut self, chunk: &RawRecord<'_>, most: u64) -> Checked<()> {
        let found = match records(chunk.content, chunk.is_whole(), most) {
            Err(Broken::Content(_)) if !chunk.is_whole() => return Ok(()),
            found => found.map_err(|why| damaged(&why))?,
        };
        let mut left = found.len();
        for record in raw_records(&found) {
            left -= HEAD + record.content.len();
            match record.is_whole() {
                true => self.take(record.opcode, record.content)?,
                false if chunk.is_whole() => return Err(damaged(&SHORT).into()),
                false => (),
            }
        }
        if chunk.is_whole() && left > 0 { Err(damaged(&SHORT).into()) } else { Ok(()) }
    }

    fn take(&mut self, opcode: u8, data: &[u8]) -> Checked<()> {
        let broken = |why: Broken| damaged(&why);
        let mut fields = Fields(data);
        match opcode {
            op::SCHEMA => {
                let (id, name) = (fields.u16().map_err(broken)?, fields.text().map_err(broken)?);
                // encoding, and the definition
                fields
                    .text()
                    .and_then(|_| fields.u32())
                    .and_then(|length| fields.bytes(length.into()))
                    .map_err(broken)?;
                self.schemas.insert(id, name.to_owned());
            }
            op::CHANNEL => {
                let channel = ChannelRecord::read(fields).map_err(broken)?;
                let schema = self.schemas.get(&channel.schema_id).map_or("", String::as_str);
                // chunks repeat it
                if !self.channels.contains_key(&channel.id) {
                    let connection = self.bag.connect(channel.topic, schema, channel.message_encoding)?;
                    self.channels.insert(channel.id, connection);
                }
            }
            op::MESSAGE => {
                let id = fields.u16().map_err(broken)?;
                // its number, and the time when it was sent
                let log_time_ns = fields.u32().and_then(|_| fields.u64()).map_err(broken)?;
                fields.u64().map_err(broken)?;
                let Some(channel) = self.channels.get(&id) else { return Ok(()) };
                self.bag.take(channel, log_time_ns, fields.0)?;
            }
            _ => (),
        }
        Ok(())
    }
}

fn damaged(error: &Broken) -> InputError {
    match error {
        Broken::Compression(name) => InputError::new(
            Refusal::FormatUnsupported,
            format!("the bag is compressed with {name}, which is not read"),
            "write it again with zstd: `mcap compress --compression zstd`",
        ),
        Broken::Content(why) => InputError::new(
            Refusal::FileDamaged,
            format!("the MCAP container is damaged: {why}"),
            "try `mcap recover`",
        ),
    }
}
