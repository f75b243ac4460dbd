//! Reads ROS 2 bags in MCAP containers: messages `sensor_msgs/msg/Imu` in CDR.
//!
//! By the message's definition, angular velocity is in rad/s, and linear acceleration is in m/s² with
//! gravity. [`readings`](super::reading_unit) checks that. Times are `header.stamp`, when the sample was
//! taken, and not when the recorder received it. A covariance that begins with −1 marks a sensor as absent.

use super::cdr::{self, ImuMessage};
use super::column::{ColumnMeaning, ImuColumn};
use super::column_values::{SLOTS, Samples, TIME, slots_of};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::mcap_footer::Cut;
use super::mcap_records::chunk_lengths_add_up;
use super::options::ImuReadOptions;
use super::unit::{ColumnUnit, ImuUnit, TimeUnit};
use crate::recording::finding_words::{count, list};
use crate::recording::reader_finding::Finding;
use crate::text_decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{Axis, SensorKind};
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};
use std::collections::BTreeMap;

/// Names of the message's type.
const IMU: [&str; 2] = ["sensor_msgs/msg/Imu", "sensor_msgs/msg/dds_/Imu_"];
/// Bytes that the container's reader receives at once.
const PIECE: usize = 1 << 20;
/// A record may have this many bytes, even where the compressed file has fewer: a map that was latched.
const LARGEST_RECORD: usize = 1 << 28;
/// Opcode of a record with a schema.
const SCHEMA: u8 = 3;
/// Opcode of a record with a channel.
const CHANNEL: u8 = 4;
/// Opcode of a record with a message.
const MESSAGE: u8 = 5;

/// The topics of the container, and the messages of those with IMUs.
#[derive(Default)]
struct Bag {
    /// Name of each schema.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
}

struct Channel {
    topic: String,
    schema: String,
    messages: Vec<ImuMessage>,
}

/// Columns and values of the bag's IMU, and a warning where the bag has no end.
pub(super) fn read(bytes: &[u8], options: &ImuReadOptions) -> Checked<(Draft, Samples, Option<Finding>)> {
    let cut = Cut::of(bytes);
    let bag = Bag::read(bytes, cut.is_some())?;
    if let Some(cut) = cut.as_ref().filter(|_| !bag.has_messages()) {
        return Err(cut.input_error().into());
    }
    let messages = bag.messages(options.topic.as_deref())?;
    let origin = messages.first().map_or(0, |message| message.stamp_ns);
    let mut columns: [Vec<f64>; SLOTS] = Default::default();
    columns[TIME] = messages.iter().map(|message| (message.stamp_ns - origin) as f64).collect();
    let mut described = vec![ImuColumn::new(
        "header.stamp",
        ColumnMeaning::Time,
        Some(ColumnUnit::Time(TimeUnit::Nanosecond)),
    )];
    for (sensor_kind, name, unit) in [
        (SensorKind::Gyroscope, "angular_velocity", ImuUnit::RadianPerSecond),
        (SensorKind::Accelerometer, "linear_acceleration", ImuUnit::MetrePerSecondSquared),
    ] {
        let absent = messages.iter().all(|message| message.sensor(sensor_kind).is_none());
        for axis in Axis::ALL {
            let meaning = ColumnMeaning::Reading(sensor_kind, axis);
            let mut column =
                ImuColumn::new(&format!("{name}.{axis}"), meaning, Some(ColumnUnit::Reading(unit)));
            if absent {
                column.unused = Some("its covariance begins with −1: the IMU does not have it".into());
            } else {
                let value =
                    |message: &ImuMessage| message.sensor(sensor_kind).map_or(f64::NAN, |y| y[axis.index()]);
                columns[slots_of(sensor_kind)[axis.index()]] = messages.iter().map(value).collect();
            }
            described.push(column);
        }
    }
    described.push(ImuColumn::new("orientation", ColumnMeaning::Orientation, None));
    let last_s = messages.last().map_or(0.0, |message| (message.stamp_ns - origin) as f64 / 1e9);
    let cut = cut.map(|cut| cut.finding(messages.len(), last_s));
    Ok((Draft::new(FileFormat::Mcap, described), Samples::from_columns(columns, origin)?, cut))
}

impl Bag {
    fn read(bytes: &[u8], is_cut: bool) -> Checked<Self> {
        if !chunk_lengths_add_up(bytes.get(MAGIC.len()..).unwrap_or_default()) {
            return Err(damaged(&McapError::UnexpectedEoc).into());
        }
        let mut bag = Self::default();
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

    fn has_messages(&self) -> bool {
        self.channels.values().any(|channel| !channel.messages.is_empty())
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
                if IMU.contains(&schema.as_str()) && channel.message_encoding != "cdr" {
                    let message = format!(
                        "messages of `{}` are encoded as `{}`",
                        channel.topic, channel.message_encoding
                    );
                    return Err(
                        InputError::new(Refusal::FormatUnsupported, message, "only CDR is read").into()
                    );
                }
                let new = || Channel { topic: channel.topic.clone(), schema, messages: Vec::new() };
                self.channels.entry(channel.id).or_insert_with(new);
            }
            Record::Message { header, data } => {
                let Some(channel) = self.channels.get_mut(&header.channel_id) else { return Ok(()) };
                if !IMU.contains(&channel.schema.as_str()) {
                    return Ok(());
                }
                let number = channel.messages.len() + 1;
                let message = cdr::imu(&data).map_err(|why| {
                    let message = format!("message {number} of `{}` cannot be read: {why}", channel.topic);
                    InputError::new(
                        Refusal::FileDamaged,
                        message,
                        "was it recorded as sensor_msgs/msg/Imu by ROS 2?",
                    )
                })?;
                channel.messages.push(message);
            }
            _ => (),
        }
        Ok(())
    }

    /// The messages of the wanted topic.
    fn messages(mut self, topic: Option<&str>) -> Checked<Vec<ImuMessage>> {
        let mut topics: BTreeMap<String, Vec<ImuMessage>> = BTreeMap::new();
        let is_imu = |channel: &Channel| IMU.contains(&channel.schema.as_str());
        for channel in self.channels.values_mut().filter(|channel| is_imu(channel)) {
            topics.entry(channel.topic.clone()).or_default().append(&mut channel.messages);
        }
        let named = |names: Vec<String>| list(&names, 10);
        if let Some(topic) = topic {
            let known = named(topics.keys().cloned().collect());
            return topics.remove(topic).filter(|messages| !messages.is_empty()).ok_or_else(|| {
                let has = if known.is_empty() { "none".to_owned() } else { known };
                let message = format!("there are no messages of sensor_msgs/msg/Imu on `{topic}`; the topics of such messages: {has}");
                InputError::new(Refusal::TopicUnknown, message, "names count letter by letter, the slash too").into()
            });
        }
        topics.retain(|_, messages| !messages.is_empty());
        if topics.len() > 1 {
            let each = topics
                .iter()
                .map(|(topic, messages)| format!("{topic} ({})", count(messages.len(), "message")));
            let message = format!("there is more than one IMU: {}", each.collect::<Vec<_>>().join(", "));
            return Err(InputError::new(
                Refusal::TopicUnknown,
                message,
                "say --topic, or topic in [columns]",
            )
            .into());
        }
        topics.into_values().next().ok_or_else(|| {
            let others: Vec<String> = self
                .channels
                .values()
                .map(|channel| format!("{} ({})", channel.topic, channel.schema))
                .collect();
            let message = if others.is_empty() {
                "the bag has no topics".to_owned()
            } else {
                format!("the bag has no messages of sensor_msgs/msg/Imu; its topics are {}", named(others))
            };
            InputError::new(Refusal::TopicUnknown, message, "record the topic of the IMU").into()
        })
    }
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
