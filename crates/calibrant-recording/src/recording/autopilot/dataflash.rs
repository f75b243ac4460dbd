//! Reads ArduPilot's DataFlash logs.
//!
//! ```text
//! message  a3 95, type u8, fields
//!   type 80 hexadecimal, a format: type u8, length u8 with these three bytes, name 4, a letter for each field 16, names of the fields 64
//! ```

use super::layout::{Field, Layout, Scalar};
use super::log::{AutopilotLog, PassedOver};
use super::stream::{Collector, Topic};
use calibrant_core::sensor::SensorKind::{Accelerometer, Gyroscope};

pub(crate) const MAGIC: &[u8] = b"\xa3\x95\x80";
/// Begins every message.
const HEAD: &[u8] = b"\xa3\x95";
/// The type of formats, and their length.
const FORMAT: (u8, usize) = (0x80, 89);

/// `TimeMS` was in logs until 2014.
const CLOCKS: &[(&str, f64)] = &[("SampleUS", 1.0), ("TimeUS", 1.0), ("TimeMS", 1e3)];
const ACCELEROMETER: [&str; 3] = ["AccX", "AccY", "AccZ"];
const GYROSCOPE: [&str; 3] = ["GyrX", "GyrY", "GyrZ"];

/// The messages that have readings of an IMU.
static TOPICS: [Topic; 4] = [
    Topic::new("ACC", Accelerometer, CLOCKS, ACCELEROMETER),
    Topic::new("GYR", Gyroscope, CLOCKS, GYROSCOPE),
    Topic { temperature: Some("T"), ..Topic::new("IMU", Accelerometer, CLOCKS, ACCELEROMETER) },
    Topic { temperature: Some("T"), ..Topic::new("IMU", Gyroscope, CLOCKS, GYROSCOPE) },
];

/// A type of messages.
#[derive(Default)]
struct Format {
    /// Bytes of a message without its head; `None` of a type that was not described.
    length: Option<usize>,
    layout: Layout,
    topics: Vec<&'static Topic>,
    /// The number in its name, from 0: `IMU2`.
    instance: u8,
    /// The field that numbers the sensor of a message, where there is one.
    number: Option<Field>,
    /// The collectors of its sensors.
    collectors: Vec<(u8, Vec<usize>)>,
}

/// Reads the readings of a log.
pub(crate) fn read(bytes: &[u8]) -> AutopilotLog {
    let mut formats: Vec<Format> = std::iter::repeat_with(Format::default).take(256).collect();
    formats[usize::from(FORMAT.0)].length = Some(FORMAT.1 - 3);
    let (mut collectors, mut passed_over) = (Vec::new(), PassedOver::default());
    let mut rest = bytes;
    while !rest.is_empty() {
        if let Some((kind, content)) = message(rest, &formats) {
            match kind == FORMAT.0 {
                true => describe(&mut formats, content),
                false => formats[usize::from(kind)].take(content, &mut collectors),
            }
            rest = &rest[3 + content.len()..];
            continue;
        }
        let next = memchr::memmem::find(&rest[1..], HEAD).map(|at| 1 + at);
        // without another message, the last one was cut off as the power was
        if next.is_some() || !rest.starts_with(HEAD) {
            passed_over.add(next.unwrap_or(rest.len()));
        }
        rest = next.map_or(&[], |next| &rest[next..]);
    }
    let streams = collectors.into_iter().map(|collector: Collector| collector.stream);
    AutopilotLog {
        streams: streams.filter(|stream| !stream.readings.is_empty()).collect(),
        version: None,
        passed_over,
    }
}

/// Type and content of the message that begins here; `None` where there is no whole one of a known type.
fn message<'b>(bytes: &'b [u8], formats: &[Format]) -> Option<(u8, &'b [u8])> {
    let (&[kind], rest) = bytes.strip_prefix(HEAD)?.split_first_chunk()?;
    Some((kind, rest.get(..formats[usize::from(kind)].length?)?))
}

/// Takes a format. One that repeats an earlier one changes nothing.
fn describe(formats: &mut [Format], content: &[u8]) {
    let text = |range: std::ops::Range<usize>| {
        let bytes = content.get(range).unwrap_or_default();
        String::from_utf8_lossy(bytes.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned()
    };
    let [kind, length, ..] = *content else { return };
    let Some(length) = usize::from(length).checked_sub(3) else { return };
    let format = &mut formats[usize::from(kind)];
    if kind == FORMAT.0 || format.length == Some(length) {
        return;
    }
    let name = text(2..6);
    let number = name.trim_start_matches(|c: char| !c.is_ascii_digit());
    let base = &name[..name.len() - number.len()];
    let mut layout = Layout::new();
    for (letter, name) in text(6..22).chars().zip(text(22..86).split(',')) {
        match scalar(letter) {
            Ok(scalar) => layout.add(name, scalar, 1),
            Err(bytes) => layout.skip(bytes),
        }
    }
    *format = Format {
        length: Some(length),
        number: layout.field("I"),
        layout,
        topics: TOPICS.iter().filter(|topic| topic.name == base).collect(),
        // `IMU` is followed by `IMU2`, `ACC1` is the first
        instance: number.parse::<u8>().unwrap_or(1).saturating_sub(1),
        collectors: Vec::new(),
    };
}

impl Format {
    /// Takes a message of this type.
    fn take(&mut self, content: &[u8], all: &mut Vec<Collector>) {
        if self.topics.is_empty() {
            return;
        }
        let number = self.number.and_then(|field| field.value(content));
        let instance = number.map_or(self.instance, |number| number as u8);
        let known = self.collectors.iter().position(|(known, _)| *known == instance);
        let known = known.unwrap_or_else(|| {
            let new = self.topics.iter().filter_map(|topic| Collector::new(topic, &self.layout, instance));
            let begin = all.len();
            all.extend(new);
            self.collectors.push((instance, (begin..all.len()).collect()));
            self.collectors.len() - 1
        });
        for &k in &self.collectors[known].1 {
            all[k].take(content);
        }
    }
}

/// The number that a letter of a format stands for, with its factor; or else its bytes, where they are known.
fn scalar(letter: char) -> Result<(Scalar, f64), Option<usize>> {
    let whole = |scalar| Ok((scalar, 1.0));
    let hundredth = |scalar| Ok((scalar, 0.01));
    match letter {
        'b' => whole(Scalar::I8),
        'B' | 'M' => whole(Scalar::U8),
        'h' => whole(Scalar::I16),
        'H' => whole(Scalar::U16),
        'i' | 'L' => whole(Scalar::I32),
        'I' => whole(Scalar::U32),
        'q' => whole(Scalar::I64),
        'Q' => whole(Scalar::U64),
        'f' => whole(Scalar::F32),
        'd' => whole(Scalar::F64),
        'c' => hundredth(Scalar::I16),
        'C' => hundredth(Scalar::U16),
        'e' => hundredth(Scalar::I32),
        'E' => hundredth(Scalar::U32),
        'n' => Err(Some(4)),
        'N' => Err(Some(16)),
        'a' | 'Z' => Err(Some(64)),
        _ => Err(None),
    }
}
