//! Reads PX4's ULog.
//!
//! ```text
//! header   ULog 01 12 35, version u8, time u64
//! message  length u16, type u8, content
//!   B flags      compatible 8, incompatible 8, three places u64 where data were appended
//!   F format     name:type field;type[3] field;…
//!   I info       length of the key u8, key "type name", value
//!   A subscribe  instance u8, number u16, name of the format
//!   D data       number u16, fields
//!   S sync       2f 73 13 20 25 0c bb 12
//! ```

use super::layout::{Layout, Scalar};
use super::log::{AutopilotLog, PassedOver};
use super::stream::{Collector, Topic};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::SensorKind::{Accelerometer, Gyroscope};
use std::collections::HashMap;

pub(crate) const MAGIC: &[u8] = b"ULog\x01\x12\x35";
/// Bytes of the header.
const HEADER: usize = 16;
/// A message of synchronisation.
const SYNC: &[u8] = b"\x08\0S\x2f\x73\x13\x20\x25\x0c\xbb\x12";

const SAMPLE: &[(&str, f64)] = &[("timestamp_sample", 1.0), ("timestamp", 1.0)];
const XYZ: [&str; 3] = ["x", "y", "z"];
const FORCE: [&str; 3] = ["accelerometer_m_s2[0]", "accelerometer_m_s2[1]", "accelerometer_m_s2[2]"];
const RATE: [&str; 3] = ["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"];
const TEMPERATURE: Option<&str> = Some("temperature");
const FIFO: Option<[&str; 3]> = Some(["dt", "scale", "samples"]);

/// The topics that have readings of an IMU.
static TOPICS: [Topic; 6] = [
    Topic { fifo: FIFO, ..Topic::new("sensor_accel_fifo", Accelerometer, SAMPLE, XYZ) },
    Topic { fifo: FIFO, ..Topic::new("sensor_gyro_fifo", Gyroscope, SAMPLE, XYZ) },
    Topic { temperature: TEMPERATURE, ..Topic::new("sensor_accel", Accelerometer, SAMPLE, XYZ) },
    Topic { temperature: TEMPERATURE, ..Topic::new("sensor_gyro", Gyroscope, SAMPLE, XYZ) },
    Topic {
        later_us: Some("accelerometer_timestamp_relative"),
        ..Topic::new("sensor_combined", Accelerometer, SAMPLE, FORCE)
    },
    Topic::new("sensor_combined", Gyroscope, SAMPLE, RATE),
];

/// A log while it is read.
#[derive(Default)]
struct Reader {
    formats: HashMap<String, Layout>,
    collectors: Vec<Collector>,
    /// The collectors of each number of a subscription.
    subscribed: Vec<Vec<usize>>,
    version: Option<(u8, u8)>,
    appended_at: Vec<usize>,
    passed_over: PassedOver,
}

/// Reads the readings of a log.
pub(crate) fn read(bytes: &[u8]) -> Checked<AutopilotLog> {
    let mut reader = Reader::default();
    let mut begin = HEADER;
    // the first message says where data were appended
    if let Some(flags) = bytes.get(HEADER..).and_then(message).filter(|(kind, _)| *kind == b'B') {
        reader.flags(flags.1)?;
    }
    let ends = reader.appended_at.clone();
    for end in ends.into_iter().chain([bytes.len()]).filter(|end| *end <= bytes.len()) {
        if let Some(part) = bytes.get(begin..end) {
            reader.messages(part);
            begin = end;
        }
    }
    let streams = reader.collectors.into_iter().map(|collector| collector.stream);
    let streams = streams.filter(|stream| !stream.readings.is_empty()).collect();
    Ok(AutopilotLog { streams, version: reader.version, passed_over: reader.passed_over })
}

/// Type and content of the message that begins here; `None` where there is no whole one.
fn message(bytes: &[u8]) -> Option<(u8, &[u8])> {
    let (&[low, high, kind], rest) = bytes.split_first_chunk()?;
    let content = rest.get(..usize::from(u16::from_le_bytes([low, high])))?;
    // newer versions may have other types of messages
    (kind.is_ascii_uppercase() && !content.is_empty()).then_some((kind, content))
}

impl Reader {
    fn messages(&mut self, part: &[u8]) {
        let mut rest = part;
        while !rest.is_empty() {
            if let Some((kind, content)) = message(rest) {
                self.take(kind, content);
                rest = &rest[3 + content.len()..];
                continue;
            }
            let next = memchr::memmem::find(rest, SYNC);
            let is_cut_off = rest.len() < 3 || rest[2].is_ascii_uppercase() && rest[..2] != [0, 0];
            // without another message, the last one was cut off as the power was
            if next.is_some() || !is_cut_off {
                self.passed_over.add(next.unwrap_or(rest.len()));
            }
            rest = next.map_or(&[], |next| &rest[next..]);
        }
    }

    fn take(&mut self, kind: u8, content: &[u8]) -> Option<()> {
        match kind {
            b'F' => {
                let (name, fields) = str::from_utf8(content).ok()?.split_once(':')?;
                if TOPICS.iter().any(|topic| topic.name == name) {
                    self.formats.insert(name.to_owned(), layout(fields));
                }
            }
            b'I' => {
                let (&length, rest) = content.split_first()?;
                let (key, value) = rest.split_at_checked(length.into())?;
                if key == b"uint32_t ver_sw_release" {
                    let [.., minor, major] = *value.first_chunk::<4>()?;
                    self.version = Some((major, minor));
                }
            }
            b'A' => {
                let (&[instance, low, high], name) = content.split_first_chunk()?;
                let number = usize::from(u16::from_le_bytes([low, high]));
                let name = str::from_utf8(name).ok()?;
                let layout = self.formats.get(name)?;
                if self.subscribed.len() <= number {
                    self.subscribed.resize_with(number + 1, Vec::new);
                }
                self.subscribed[number].clear();
                for topic in TOPICS.iter().filter(|topic| topic.name == name) {
                    let Some(collector) = Collector::new(topic, layout, instance) else { continue };
                    self.subscribed[number].push(self.collectors.len());
                    self.collectors.push(collector);
                }
            }
            b'D' => {
                let (number, fields) = content.split_first_chunk()?;
                for &k in self.subscribed.get(usize::from(u16::from_le_bytes(*number)))? {
                    self.collectors[k].take(fields);
                }
            }
            _ => (),
        }
        Some(())
    }

    /// Takes the flags of the log; an error where they say that it cannot be read as it is usual.
    fn flags(&mut self, content: &[u8]) -> Checked<()> {
        let (flags, places) = content.split_at_checked(16).unwrap_or_default();
        if flags.iter().enumerate().skip(8).any(|(k, flag)| *flag & !u8::from(k == 8) != 0) {
            return refuse(
                Refusal::FormatUnsupported,
                "the log says that it is of a newer form of ULog, which is not read",
                "convert it: `ulog2csv -m sensor_accel,sensor_gyro,sensor_combined FILE`, and give the .csv",
            );
        }
        let places = places.chunks_exact(8).filter_map(|place| place.first_chunk());
        let places = places.filter_map(|place| usize::try_from(u64::from_le_bytes(*place)).ok());
        self.appended_at = places.filter(|place| *place > 0).collect();
        self.appended_at.sort_unstable();
        Ok(())
    }
}

/// The fields of a format: `uint64_t timestamp;float[3] gyro_rad;…`.
fn layout(fields: &str) -> Layout {
    let mut layout = Layout::new();
    for field in fields.split(';') {
        let Some((kind, name)) = field.split_once(' ') else { continue };
        let (kind, count) = match kind.strip_suffix(']').and_then(|kind| kind.split_once('[')) {
            Some((kind, count)) => (kind, count.parse().ok()),
            None => (kind, Some(1)),
        };
        match scalar(kind).zip(count) {
            Some((scalar, count)) => layout.add(name, (scalar, 1.0), count),
            None => layout.skip(None),
        }
    }
    layout
}

fn scalar(kind: &str) -> Option<Scalar> {
    Some(match kind {
        "int8_t" => Scalar::I8,
        "uint8_t" | "bool" | "char" => Scalar::U8,
        "int16_t" => Scalar::I16,
        "uint16_t" => Scalar::U16,
        "int32_t" => Scalar::I32,
        "uint32_t" => Scalar::U32,
        "int64_t" => Scalar::I64,
        "uint64_t" => Scalar::U64,
        "float" => Scalar::F32,
        "double" => Scalar::F64,
        _ => return None,
    })
}
