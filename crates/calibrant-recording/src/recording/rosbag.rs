//! Reads the messages of ROS 1 bags.
//!
//! ```text
//! record   length u32, head, length u32, data
//! head     fields: length u32, name=value
//! op 2 message (conn u32, time s u32 and ns u32), 5 chunk of records (compression, size u32), 7 connection (conn, topic; data: fields with the type)
//! ```
//! The records are read in their order: the index at the end is not needed.

use super::bag::{Bag, Connection, MessageType, ROS1};
use super::mcap_chunk::unpacked;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::reader::LogPassedOver;
use calibrant_core::error::{InputError, Refusal};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Begins a bag.
const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// A chunk may have this many bytes, even where the compressed file has fewer.
const LARGEST_CHUNK: usize = 1 << 28;
/// Kinds of records.
mod op {
    pub(super) const MESSAGE: u8 = 2;
    pub(super) const CHUNK: u8 = 5;
    pub(super) const CONNECTION: u8 = 7;
}

/// A record: the fields of its head, and its data.
struct Record<'b> {
    head: &'b [u8],
    data: &'b [u8],
}

pub(super) fn read<'t, M>(bytes: &[u8], types: &'t [MessageType<M>]) -> Checked<Bag<'t, M>> {
    let mut reader = Reader { bag: Bag::new(types), connections: BTreeMap::new() };
    let mut rest = bytes.strip_prefix(MAGIC).unwrap_or_default();
    while let Some(record) = next(&mut rest) {
        match record.op() {
            Some(op::CHUNK) => {
                let records = record.chunk(bytes.len().max(LARGEST_CHUNK))?;
                let mut rest: &[u8] = &records;
                while let Some(record) = next(&mut rest) {
                    reader.take(&record)?;
                }
                if !rest.is_empty() {
                    return Err(damaged("a chunk ends within a record").into());
                }
            }
            Some(_) => reader.take(&record)?,
            None => return Err(damaged("a record does not say what it is").into()),
        }
    }
    if reader.connections.is_empty() {
        return Err(damaged("it ends before any message").into());
    }
    if !rest.is_empty() {
        reader.bag.unread = Some(LogPassedOver { bytes: rest.len(), places: 1 }.into());
    }
    Ok(reader.bag)
}

struct Reader<'t, M> {
    bag: Bag<'t, M>,
    connections: BTreeMap<u32, Connection<'t, M>>,
}

impl<M> Reader<'_, M> {
    fn take(&mut self, record: &Record<'_>) -> Checked<()> {
        let number = |name: &str| record.field(name).and_then(|value| value.first_chunk());
        let Some(connection) = number("conn").map(|bytes| u32::from_le_bytes(*bytes)) else { return Ok(()) };
        match record.op() {
            Some(op::CONNECTION) => {
                let text =
                    |value: Option<&[u8]>| String::from_utf8_lossy(value.unwrap_or_default()).into_owned();
                let kind = text(field(record.data, "type"));
                let topic = text(record.field("topic"));
                self.connections.insert(connection, self.bag.connect(&topic, &kind, ROS1)?);
            }
            Some(op::MESSAGE) => {
                let Some(connection) = self.connections.get(&connection) else { return Ok(()) };
                let time = record.field("time").and_then(|time| time.first_chunk::<8>()).copied();
                let [a, b, c, d, ns @ ..] = time.unwrap_or_default();
                let (s, ns) = (u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes(ns));
                let log_time_ns = u64::from(s) * 1_000_000_000 + u64::from(ns);
                self.bag.take(connection, log_time_ns, record.data)?;
            }
            _ => (),
        }
        Ok(())
    }
}

/// The next record; `None` where there is no whole one.
fn next<'b>(bytes: &mut &'b [u8]) -> Option<Record<'b>> {
    let mut rest = *bytes;
    let mut part = || {
        let (length, after) = rest.split_first_chunk()?;
        let (part, after) = after.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        rest = after;
        Some(part)
    };
    let record = Record { head: part()?, data: part()? };
    *bytes = rest;
    Some(record)
}

/// The value of a field.
fn field<'b>(fields: &'b [u8], name: &str) -> Option<&'b [u8]> {
    let mut rest = fields;
    while let Some((length, after)) = rest.split_first_chunk() {
        let (one, after) = after.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        if let Some(value) = one.strip_prefix(name.as_bytes()).and_then(|value| value.strip_prefix(b"=")) {
            return Some(value);
        }
        rest = after;
    }
    None
}

impl<'b> Record<'b> {
    fn field(&self, name: &str) -> Option<&'b [u8]> {
        field(self.head, name)
    }

    fn op(&self) -> Option<u8> {
        self.field("op")?.first().copied()
    }

    /// The records of a chunk, unpacked: this many bytes at most.
    fn chunk(&self, most: usize) -> Checked<Cow<'b, [u8]>> {
        let size = self
            .field("size")
            .and_then(|size| size.first_chunk())
            .map_or(0, |size| u32::from_le_bytes(*size));
        if size as usize > most {
            return Err(damaged("a chunk states more bytes than a bag may have").into());
        }
        let records = match self.field("compression") {
            None | Some(b"none") => Cow::Borrowed(self.data),
            Some(b"lz4") => unpacked(Ok(lz4_flex::frame::FrameDecoder::new(self.data)), size.into()),
            Some(other) => {
                let name = String::from_utf8_lossy(other);
                return refuse(
                    Refusal::FormatUnsupported,
                    format!("the bag is compressed with {name}, which is not read"),
                    "decompress it: `rosbag decompress FILE.bag`, or without ROS `rosbags-convert --src FILE.bag --dst DIR --dst-storage mcap`, and give the .mcap file in DIR",
                );
            }
        };
        if records.len() != size as usize {
            return Err(damaged("a chunk has not the length that it states").into());
        }
        Ok(records)
    }
}

fn damaged(why: &str) -> InputError {
    InputError::new(
        Refusal::FileDamaged,
        format!("the bag is damaged: {why}"),
        "copy it again, or try `rosbag reindex FILE.bag`",
    )
}
