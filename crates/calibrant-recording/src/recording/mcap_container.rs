//! Reads the messages of ROS 2 bags in MCAP containers, of the types that a reader asks for, in CDR.

use super::cdr::Unreadable;
use super::mcap_chunk::{Broken, Fields, MAGIC, SHORT, records};
use super::mcap_footer::{Cut, unread_after};
use super::mcap_order::Logged;
use super::mcap_records::{HEAD, RawRecord, op, raw_records};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::number_format::counted;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A chunk may have this many bytes, even where the compressed file has fewer: a map that was latched.
const LARGEST_CHUNK: usize = 1 << 28;
/// Bytes of a message that was compressed by itself, at most.
const LARGEST_MESSAGE: usize = 1 << 24;
/// A frame of zstd begins with this.
const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

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
        let Some(content) = bytes.strip_prefix(MAGIC) else {
            return Err(damaged(&Broken::Content("it does not begin as one")).into());
        };
        let (schemas, channels, messages) = Default::default();
        let (cut, unread) = (Cut::of(bytes), unread_after(bytes));
        let mut bag = Self { types, schemas, channels, messages, cut, unread };
        let most = bytes.len().max(LARGEST_CHUNK) as u64;
        for record in raw_records(content) {
            match record.opcode {
                op::FOOTER => break,
                op::CHUNK => bag.take_chunk(&record, most)?,
                _ if !record.is_whole() => (),
                _ => bag.take(record.opcode, record.content)?,
            }
        }
        Ok(bag)
    }

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
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let message_type = self.types.iter().find(|one| one.is(&schema));
                if message_type.is_some() && channel.message_encoding != "cdr" {
                    let message = format!(
                        "messages of `{}` are encoded as `{}`",
                        channel.topic, channel.message_encoding
                    );
                    return refuse(Refusal::FormatUnsupported, message, "only CDR is read");
                }
                let topic = channel.topic.to_owned();
                if message_type.is_some() {
                    self.messages.entry(topic.clone()).or_default();
                }
                let new = || Channel { topic, schema, message_type };
                self.channels.entry(channel.id).or_insert_with(new);
            }
            op::MESSAGE => {
                let id = fields.u16().map_err(broken)?;
                // its number, and the time when it was sent
                let log_time_ns = fields.u32().and_then(|_| fields.u64()).map_err(broken)?;
                fields.u64().map_err(broken)?;
                let Some(channel) = self.channels.get(&id) else { return Ok(()) };
                let Some(message_type) = channel.message_type else { return Ok(()) };
                let Some(of_topic) = self.messages.get_mut(&channel.topic) else { return Ok(()) };
                let message =
                    unpacked(fields.0).and_then(|data| (message_type.read)(&data)).map_err(|why| {
                        let (number, topic) = (of_topic.len() + 1, &channel.topic);
                        let message = format!("message {number} of `{topic}` cannot be read: {why}");
                        let help = format!("was it recorded as {} by ROS 2?", message_type.name);
                        InputError::new(Refusal::FileDamaged, message, help)
                    })?;
                of_topic.push(Logged { log_time_ns, message });
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
    /// The messages of one topic, which has to be named where there are several of `what`: in this section of an experiment file, too.
    pub(crate) fn one(mut self, topic: Option<&str>, what: &str, section: &str) -> Checked<Vec<Logged<M>>> {
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
            let help = format!("say option `topic`, or topic in [{section}]");
            let error = InputError::new(Refusal::TopicUnknown, message, help);
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
