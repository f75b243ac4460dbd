//! Reads a list of the sections of a Ferraris session, as imucal writes it:
//! `{"x_p": {"start": 540, "end": 1271}, …, "x_rot": …}`, by sample.

use crate::motion::commanded::shorten;
use crate::text::decoding::{self, Checked, refuse};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;
use std::path::Path;

/// Largest list, bytes.
const LARGEST: u64 = 1 << 20;
/// The remedy for a broken list.
const EXAMPLE: &str = "write {\"x_p\": {\"start\": 540, \"end\": 1271}, …}, in samples";
/// The names of sections, for messages.
const NAMES: &str = "x_p, x_a, y_p, … (an axis up, or down) and x_rot, y_rot, z_rot";

/// One section: from sample `start` up to, not including, sample `end`.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Its name: `x_p`, `x_rot`.
    pub name: String,
    /// The action in it.
    pub kind: SectionKind,
    /// First sample.
    pub start: usize,
    /// One past the last sample.
    pub end: usize,
}

/// The action in a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SectionKind {
    /// Held still, the specific force along this direction.
    Face(Vector3<f64>),
    /// Turned about this axis.
    Turn(Vector3<f64>),
}

/// Reads a list of sections, in order of time.
///
/// # Errors
/// [`Error::Experiment`] with the file: it cannot be read or is no such list, a name is not known, or a
/// section has no samples.
pub fn read_sections(path: &Path) -> Result<Vec<Section>> {
    decoding::parsed(path, (LARGEST, "the list of sections"), parse)
}

/// Reads the bytes of a list of sections.
///
/// # Errors
/// As [`read_sections`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_recording::{SectionKind, parse_sections};
/// use nalgebra::Vector3;
/// let sections = parse_sections(br#"{"x_a": {"start": 90, "end": 99}, "z_rot": {"start": 5, "end": 80}}"#)?;
/// assert_eq!(sections[0].kind, SectionKind::Turn(Vector3::z()));
/// assert_eq!(sections[1].kind, SectionKind::Face(-Vector3::x()));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_sections(bytes: &[u8]) -> Result<Vec<Section>> {
    parse(bytes).map_err(Error::Experiment)
}

fn parse(bytes: &[u8]) -> Checked<Vec<Section>> {
    let text = decoding::as_text(bytes)?;
    let List(list) = serde_json::from_str(text).map_err(|error| {
        if error.is_data() {
            return InputError::new(
                Refusal::SyntaxInvalid,
                "no list of sections: its names are missing",
                EXAMPLE,
            );
        }
        let input_error =
            InputError::new(Refusal::SyntaxInvalid, "no list of sections: this is not JSON", EXAMPLE);
        if error.line() > 0 {
            input_error.at_line(error.line()).at_column(error.column().max(1))
        } else {
            input_error
        }
    })?;
    let mut sections: Vec<Section> = Vec::with_capacity(list.len());
    for (name, samples) in &list {
        if sections.iter().any(|before| before.name == *name) {
            let message = format!("the section \"{}\" is there twice", shorten(name));
            return refuse(
                Refusal::KeyRepeated,
                message,
                "a list has each name once; more faces and turns: holds.intervals_s, directions and gyroscope.turns in the experiment file",
            );
        }
        let kind = kind(name).ok_or_else(|| {
            InputError::new(Refusal::KeyUnknown, format!("the section \"{name}\" is not known"), NAMES)
        })?;
        let (start, end) = (sample(name, samples, "start")?, sample(name, samples, "end")?);
        if let Some(other) =
            samples.as_object().and_then(|object| object.keys().find(|key| *key != "start" && *key != "end"))
        {
            let message = format!("the section \"{name}\" has a \"{}\", which is not known", shorten(other));
            return refuse(Refusal::KeyUnknown, message, EXAMPLE);
        }
        if end.checked_sub(start).is_none_or(|samples| samples < 2) {
            let message = format!("the section \"{name}\" from sample {start} to {end} has no samples");
            return refuse(Refusal::HoldsInvalid, message, "its end must be after its start");
        }
        sections.push(Section { name: name.clone(), kind, start, end });
    }
    if sections.is_empty() {
        return refuse(Refusal::KeyMissing, "the list has no sections", NAMES);
    }
    sections.sort_by_key(|section| section.start);
    let is_face = |section: &Section| matches!(section.kind, SectionKind::Face(_));
    for (k, section) in sections.iter().enumerate() {
        let overlaps = |other: &&Section| other.start < section.end && is_face(other) == is_face(section);
        if let Some(other) = sections[k + 1..].iter().find(overlaps) {
            let message = format!("the sections \"{}\" and \"{}\" overlap", section.name, other.name);
            return refuse(Refusal::HoldsInvalid, message, "correct their samples: none may count twice");
        }
    }
    Ok(sections)
}

/// The entries of a list by name. A name that occurs twice is in it twice.
struct List(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for List {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        struct Names;
        impl<'de> Visitor<'de> for Names {
            type Value = Vec<(String, Value)>;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a list of sections")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> std::result::Result<Self::Value, A::Error> {
                let mut list = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    list.push(entry);
                }
                Ok(list)
            }
        }
        from.deserialize_map(Names).map(Self)
    }
}

/// The sample at which a section starts or ends.
fn sample(name: &str, samples: &Value, key: &str) -> Checked<usize> {
    let reject =
        |what: String| refuse(Refusal::ValueInvalid, format!("the section \"{name}\" {what}"), EXAMPLE);
    match samples.get(key) {
        None => reject(format!("has no \"{key}\"")),
        Some(value) => match value.as_u64().and_then(|sample| usize::try_from(sample).ok()) {
            Some(sample) => Ok(sample),
            None => {
                let shown = match value {
                    Value::String(text) => format!("the text \"{}\"", shorten(text)),
                    other => shorten(&other.to_string()),
                };
                reject(format!(
                    "has {shown} for its \"{key}\", which is no number of a sample: 0 or a whole number above it"
                ))
            }
        },
    }
}

fn kind(name: &str) -> Option<SectionKind> {
    let (axis, what) = name.split_once('_')?;
    let axis = Axis::ALL.iter().position(|known| known.to_string() == axis)?;
    let direction = Vector3::from_fn(|k, _| if k == axis { 1.0 } else { 0.0 });
    match what {
        "p" => Some(SectionKind::Face(direction)),
        "a" => Some(SectionKind::Face(-direction)),
        "rot" => Some(SectionKind::Turn(direction)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_list_of_sections_is_said_in_words() {
        for (list, says) in [
            ("{\"x_p\": {\"start\": 1", "this is not JSON"),
            ("[1, 2]", "its names are missing"),
            (r#"{"w_p": {"start": 1, "end": 9}}"#, "the section \"w_p\" is not known"),
            (r#"{"x_p": {"end": 9}}"#, "the section \"x_p\" has no \"start\""),
            (r#"{"x_p": 7}"#, "the section \"x_p\" has no \"start\""),
            (
                r#"{"x_p": {"start": -100, "end": 9}}"#,
                "\"x_p\" has -100 for its \"start\", which is no number of a sample",
            ),
            (r#"{"x_p": {"start": 0, "end": 9.5}}"#, "\"x_p\" has 9.5 for its \"end\""),
            (r#"{"x_p": {"start": 0, "end": "9"}}"#, "\"x_p\" has the text \"9\" for its \"end\""),
            (r#"{"x_p": {"start": 0, "end": 9, "stop": 9}}"#, "\"x_p\" has a \"stop\", which is not known"),
            (r#"{"x_p": {"start": 9, "end": 9}}"#, "from sample 9 to 9 has no samples"),
            ("{}", "the list has no sections"),
            (
                r#"{"x_p": {"start": 0, "end": 9}, "y_p": {"start": 20, "end": 29}, "x_p": {"start": 40, "end": 49}}"#,
                "the section \"x_p\" is there twice",
            ),
            (
                r#"{"x_p": {"start": 0, "end": 30}, "x_rot": {"start": 5, "end": 9}, "y_p": {"start": 29, "end": 49}}"#,
                "the sections \"x_p\" and \"y_p\" overlap",
            ),
            (
                r#"{"x_rot": {"start": 10, "end": 30}, "y_rot": {"start": 0, "end": 40}}"#,
                "the sections \"y_rot\" and \"x_rot\" overlap",
            ),
        ] {
            let stated = parse_sections(list.as_bytes()).expect_err(list).to_string();
            assert!(stated.contains(says), "{list}: {stated}");
            assert!(!stated.contains("usize") && !stated.contains("integer"), "{stated}");
        }
    }
}
