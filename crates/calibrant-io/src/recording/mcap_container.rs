//! Reads the messages of ROS 2 bags in MCAP containers, of the types that a reader asks for, in CDR.

use super::cdr::Unreadable;
use super::mcap_footer::{Cut, unread_after};
use super::mcap_order::Logged;
use super::mcap_records::chunk_lengths_add_up;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::number_format::counted;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Bytes that the container's reader receives at once.
const PIECE: usize = 1 << 20;
/// A record may have this many bytes, even where the compressed file has fewer: a map that was latched.
const LARGEST_RECORD: usize = 1 << 28;
/// Bytes of a message that was compressed by itself, at most.
const LARGEST_MESSAGE: usize = 1 << 24;
/// A frame of zstd begins with this.
const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];
/// Opcode of a record with a schema.
const SCHEMA: u8 = 3;
/// Opcode of a record with a channel.
const CHANNEL: u8 = 4;
/// Opcode of a record with a message.
const MESSAGE: u8 = 5;

/// A type of messages, and how one is read.
pub(crate) struct MessageType<M> {
    /// Its name: `sensor_msgs/msg/Imu`.
    pub(crate) name: &'static str,
    pub(crate) read: fn(&[u8]) -> Result<M, Unreadable>,
}

impl<M> MessageType<M> {
    /// Is it the type of this schema? Some recorders write the name of the type in DDS.
    fn is(&self, schema: &str) -> bool {
        let of_dds = || {
            let (package, name) = self.name.rsplit_once('/')?;
            schema.strip_prefix(package)?.strip_prefix("/dds_/")?.strip_suffix('_').map(|dds| dds == name)
        };
        schema == self.name || of_dds() == Some(true)
    }
}

/// The topics of a container, and the messages of those that are wanted.
pub(crate) struct Bag<'t, M> {
    types: &'t [MessageType<M>],
    /// Name of each schema.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel<'t, M>>,
    /// The messages of each topic that is wanted, in the order of the file.
    messages: BTreeMap<String, Vec<Logged<M>>>,
    cut: Option<Cut>,
    unread: Option<Diagnostic>,
}

struct Channel<'t, M> {
    topic: String,
    schema: String,
    /// `None` where its messages are not wanted.
    message_type: Option<&'t MessageType<M>>,
}

/// The messages of each topic that is wanted, and all topics, for errors.
pub(crate) struct Topics<M> {
    pub(crate) messages: BTreeMap<String, Vec<Logged<M>>>,
    /// Names of the types that are wanted.
    types: String,
    /// All topics with the names of their types.
    all: Vec<String>,
}

impl<'t, M> Bag<'t, M> {
    pub(crate) fn read(bytes: &[u8], types: &'t [MessageType<M>]) -> Checked<Self> {
        if !chunk_lengths_add_up(bytes.get(MAGIC.len()..).unwrap_or_default()) {
            return Err(damaged(&McapError::UnexpectedEoc).into());
        }
        let cut = Cut::of(bytes);
        let is_cut = cut.is_some();
        let (schemas, channels, messages) = Default::default();
        let mut bag = Self { types, schemas, channels, messages, cut, unread: unread_after(bytes) };
        let mut rest = bytes;
        let options = LinearReaderOptions::default()
            .with_record_length_limit(bytes.len().max(LARGEST_RECORD))
            .with_validate_chunk_crcs(true)
            // a recorder that was killed has written no end
            .with_skip_end_magic(true);
        let mut reader = LinearReader::new_with_options(options);
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(need)) => {
                    let length = rest.len().min(need.max(PIECE));
                    reader.insert(length).copy_from_slice(&rest[..length]);
                    reader.notify_read(length);
                    rest = &rest[length..];
                }
                Ok(LinearReadEvent::Record { data, opcode }) => bag.take(opcode, data)?,
                // a record that states more bytes than the file has is the one that was cut off
                Err(McapError::UnexpectedEof | McapError::RecordTooLarge { .. }) if is_cut => break,
                Err(error) => return Err(damaged(&error).into()),
            }
        }
        Ok(bag)
    }

    /// The missing end of the container, if it has none; an error where no message could be read before it.
    /// `whose` is what its messages are of.
    pub(crate) fn cut(&self, whose: &str) -> Checked<Option<Cut>> {
        match &self.cut {
            Some(cut) if self.messages.values().all(Vec::is_empty) => Err(cut.input_error(whose).into()),
            cut => Ok(cut.clone()),
        }
    }

    /// What there is to say of bytes behind the end of the container.
    pub(crate) fn unread(&self) -> Option<Diagnostic> {
        self.unread.clone()
    }

    fn take(&mut self, opcode: u8, data: &[u8]) -> Checked<()> {
        if ![SCHEMA, CHANNEL, MESSAGE].contains(&opcode) {
            return Ok(());
        }
        if !texts_end(opcode, data) {
            return Err(damaged(&McapError::UnexpectedEof).into());
        }
        match mcap::parse_record(opcode, data).map_err(|error| damaged(&error))? {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let message_type = self.types.iter().find(|one| one.is(&schema));
                if message_type.is_some() && channel.message_encoding != "cdr" {
                    let message = format!(
                        "messages of `{}` are encoded as `{}`",
                        channel.topic, channel.message_encoding
                    );
                    return refuse(Refusal::FormatUnsupported, message, "only CDR is read");
                }
                let topic = channel.topic.clone();
                if message_type.is_some() {
                    self.messages.entry(topic.clone()).or_default();
                }
                let new = || Channel { topic, schema, message_type };
                self.channels.entry(channel.id).or_insert_with(new);
            }
            Record::Message { header, data } => {
                let Some(channel) = self.channels.get(&header.channel_id) else { return Ok(()) };
                let Some(message_type) = channel.message_type else { return Ok(()) };
                let Some(of_topic) = self.messages.get_mut(&channel.topic) else { return Ok(()) };
                let message = unpacked(&data).and_then(|data| (message_type.read)(&data)).map_err(|why| {
                    let (number, topic) = (of_topic.len() + 1, &channel.topic);
                    let message = format!("message {number} of `{topic}` cannot be read: {why}");
                    let help = format!("was it recorded as {} by ROS 2?", message_type.name);
                    InputError::new(Refusal::FileDamaged, message, help)
                })?;
                of_topic.push(Logged { log_time_ns: header.log_time, message });
            }
            _ => (),
        }
        Ok(())
    }

    /// The messages of each topic.
    pub(crate) fn topics(self) -> Topics<M> {
        let types: Vec<&str> = self.types.iter().map(|one| one.name).collect();
        let all = self.channels.values().map(|channel| format!("{} ({})", channel.topic, channel.schema));
        Topics { types: types.join(", "), all: all.collect(), messages: self.messages }
    }
}

impl<M> Topics<M> {
    /// The messages of one topic, which has to be named where there are several of `what`.
    pub(crate) fn one(mut self, topic: Option<&str>, what: &str) -> Checked<Vec<Logged<M>>> {
        let types = &self.types;
        let named = |names: &[String]| quoted(names, 10);
        if let Some(topic) = topic {
            let known = named(&self.messages.keys().cloned().collect::<Vec<_>>());
            return self.messages.remove(topic).filter(|messages| !messages.is_empty()).ok_or_else(|| {
                let has = if known.is_empty() { "none".to_owned() } else { known };
                let message = format!(
                    "there are no messages of {types} on `{topic}`; the topics of such messages: {has}"
                );
                InputError::new(Refusal::TopicUnknown, message, "names count letter by letter, the slash too")
                    .into()
            });
        }
        self.messages.retain(|_, messages| !messages.is_empty());
        if self.messages.len() > 1 {
            let each = self
                .messages
                .iter()
                .map(|(topic, messages)| format!("{topic} ({})", counted(messages.len(), "message")));
            let message = format!("there is more than one {what}: {}", each.collect::<Vec<_>>().join(", "));
            let error =
                InputError::new(Refusal::TopicUnknown, message, "say option `topic`, or topic in [columns]");
            let topics = self.messages.keys().map(String::as_str);
            return Err(error.answered_by(TaskOption::Topic, topics).into());
        }
        self.messages.into_values().next().ok_or_else(|| {
            let message = if self.all.is_empty() {
                "the bag has no topics".to_owned()
            } else {
                format!("the bag has no messages of {types}; its topics are {}", named(&self.all))
            };
            InputError::new(Refusal::TopicUnknown, message, format!("record the topic of the {what}")).into()
        })
    }
}

/// The bytes of a message. rosbag2 may compress each one by itself, which nothing but their beginning says: one in CDR begins with a zero.
fn unpacked(data: &[u8]) -> Result<Cow<'_, [u8]>, Unreadable> {
    if !data.starts_with(ZSTD) {
        return Ok(Cow::Borrowed(data));
    }
    zstd::bulk::decompress(data, LARGEST_MESSAGE).map(Cow::Owned).map_err(|_| "it is compressed, and damaged")
}

/// Do the texts of a schema or a channel end within the record? `mcap::parse_record` reserves the bytes that
/// a text states, up to 4 GiB, before it checks that they are there.
fn texts_end(opcode: u8, data: &[u8]) -> bool {
    /// The bytes after a block that begins with its length.
    fn after(data: &[u8]) -> Option<(&[u8], &[u8])> {
        let (length, rest) = data.split_first_chunk::<4>()?;
        rest.split_at_checked(usize::try_from(u32::from_le_bytes(*length)).ok()?)
    }
    let two = |data: &[u8]| Some(after(after(data)?.1)?.1.len());
    match opcode {
        // id, name, encoding
        SCHEMA => data.get(2..).and_then(two).is_some(),
        // id, schema, topic, encoding, and pairs of texts
        CHANNEL => data.get(4..).and_then(two).is_some_and(|left| {
            after(&data[data.len() - left..]).is_some_and(|(mut pairs, _)| {
                while let Some((_, rest)) = after(pairs) {
                    pairs = rest;
                }
                pairs.is_empty()
            })
        }),
        _ => true,
    }
}

fn damaged(error: &McapError) -> InputError {
    match error {
        McapError::UnsupportedCompression(name) => InputError::new(
            Refusal::FormatUnsupported,
            format!("the bag is compressed with {name}, which is not read"),
            "write it again with zstd: `mcap compress --compression zstd`",
        ),
        error => InputError::new(
            Refusal::FileDamaged,
            format!("the MCAP container is damaged: {error}"),
            "try `mcap recover`",
        ),
    }
}
