//! The messages of a bag, of the types that a reader asks for, whatever its container.

use super::mcap_footer::Cut;
use super::mcap_order::Logged;
use super::ros_message::{Encoding, RosMessage, Unreadable};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::number_format::counted;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Bytes of a message that was compressed by itself, at most.
const LARGEST_MESSAGE: usize = 1 << 24;
/// A frame of zstd begins with this.
const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];
/// The name of ROS 1's encoding of messages.
pub(super) const ROS1: &str = "ros1";

/// A type of messages, and how one is read.
pub(crate) struct MessageType<M> {
    /// Its name in ROS 2: `sensor_msgs/msg/Imu`.
    pub(crate) name: &'static str,
    pub(crate) read: fn(&mut RosMessage<'_>) -> Result<M, Unreadable>,
}

impl<M> MessageType<M> {
    /// Is it the type of this name? That of ROS 1 has no `/msg`, and some recorders write the name in DDS.
    fn is(&self, name: &str) -> bool {
        let Some((package, own)) = self.name.split_once("/msg/") else { return false };
        let Some(rest) = name.strip_prefix(package).and_then(|rest| rest.strip_prefix('/')) else {
            return false;
        };
        let rest = rest.strip_prefix("msg/").unwrap_or(rest);
        rest == own || rest.strip_prefix("dds_/").and_then(|rest| rest.strip_suffix('_')) == Some(own)
    }
}

/// The topics of a bag, and the messages of those that are wanted.
pub(crate) struct Bag<'t, M> {
    types: &'t [MessageType<M>],
    /// All topics with the names of their types.
    all: Vec<String>,
    /// The messages of each topic that is wanted, in the order of the file.
    messages: BTreeMap<String, Vec<Logged<M>>>,
    pub(super) cut: Option<Cut>,
    /// What there is to say of bytes that were not read.
    pub(crate) unread: Option<Diagnostic>,
}

/// What messages of one number in a container are.
pub(super) struct Connection<'t, M> {
    topic: String,
    /// `None` where they are not wanted.
    wanted: Option<(&'t MessageType<M>, Encoding)>,
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
    pub(super) fn new(types: &'t [MessageType<M>]) -> Self {
        Self { types, all: Vec::new(), messages: BTreeMap::new(), cut: None, unread: None }
    }

    /// Takes what a container says of the messages of one number.
    pub(super) fn connect(&mut self, topic: &str, kind: &str, encoding: &str) -> Checked<Connection<'t, M>> {
        let described = format!("{topic} ({kind})");
        if !self.all.contains(&described) {
            self.all.push(described);
        }
        let topic = topic.to_owned();
        let Some(message_type) = self.types.iter().find(|one| one.is(kind)) else {
            return Ok(Connection { topic, wanted: None });
        };
        let encoding = match encoding {
            "cdr" => Encoding::Cdr,
            ROS1 => Encoding::Ros1,
            other => {
                let message = format!("messages of `{topic}` are encoded as `{other}`");
                return refuse(
                    Refusal::FormatUnsupported,
                    message,
                    "only CDR and the encoding of ROS 1 are read",
                );
            }
        };
        self.messages.entry(topic.clone()).or_default();
        Ok(Connection { topic, wanted: Some((message_type, encoding)) })
    }

    /// Takes a message.
    pub(super) fn take(&mut self, of: &Connection<'t, M>, log_time_ns: u64, data: &[u8]) -> Checked<()> {
        let Some((message_type, encoding)) = of.wanted else { return Ok(()) };
        let of_topic = self.messages.entry(of.topic.clone()).or_default();
        let read = || (message_type.read)(&mut RosMessage::new(&unpacked(data, encoding)?, encoding)?);
        let message = read().map_err(|why| {
            let (number, topic) = (of_topic.len() + 1, &of.topic);
            let message = format!("message {number} of `{topic}` cannot be read: {why}");
            let help = format!("was it recorded as {} by ROS?", message_type.name);
            InputError::new(Refusal::FileDamaged, message, help)
        })?;
        of_topic.push(Logged { log_time_ns, message });
        Ok(())
    }

    /// The missing end of the container, if it has none; an error where no message could be read before it.
    /// `whose` is what its messages are of.
    pub(crate) fn cut(&self, whose: &str) -> Checked<Option<Cut>> {
        match &self.cut {
            Some(cut) if self.messages.values().all(Vec::is_empty) => Err(cut.input_error(whose).into()),
            cut => Ok(cut.clone()),
        }
    }

    /// The messages of each topic.
    pub(crate) fn topics(self) -> Topics<M> {
        let types: Vec<&str> = self.types.iter().map(|one| one.name).collect();
        Topics { types: types.join(", "), all: self.all, messages: self.messages }
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
            let help = match section {
                "columns" => "say option `topic`, or topic in [columns]".to_owned(),
                section => format!("name it: topic = \"…\" in [{section}]; `inspect` takes option `topic`"),
            };
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
fn unpacked(data: &[u8], encoding: Encoding) -> Result<Cow<'_, [u8]>, Unreadable> {
    if encoding != Encoding::Cdr || !data.starts_with(ZSTD) {
        return Ok(Cow::Borrowed(data));
    }
    zstd::bulk::decompress(data, LARGEST_MESSAGE).map(Cow::Owned).map_err(|_| "it is compressed, and damaged")
}
