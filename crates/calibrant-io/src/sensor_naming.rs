//! Which sensor a recording is of, and when and where it was made: by options, by the file's name, or by the recording itself.

use super::input::file_name;
use super::utc_time::UtcTime;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::path::Path;

/// How recordings name their sensor.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SensorNaming {
    /// The sensor, where all recordings are of one.
    pub sensor: Option<String>,
    /// What the name of a recording's file says.
    pub pattern: Option<NamePattern>,
    /// The station, where it is that of all recordings.
    pub station: Option<String>,
}

/// What is named of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedRecording {
    /// The sensor.
    pub sensor: String,
    /// The station.
    pub station: Option<String>,
    /// When it was recorded.
    pub recorded: Option<UtcTime>,
}

impl SensorNaming {
    /// What is named of a recording. Where nothing names its sensor, it has the name of the file without its ending.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file's name is not of the pattern.
    pub fn of(&self, recording: &Path) -> Result<NamedRecording> {
        let found = match &self.pattern {
            Some(pattern) => pattern.find(recording)?,
            None => Found::default(),
        };
        let stem = || match recording.file_stem() {
            Some(stem) => stem.to_string_lossy().into_owned(),
            None => file_name(recording),
        };
        Ok(NamedRecording {
            sensor: self.sensor.clone().or(found.sensor).unwrap_or_else(stem),
            station: self.station.clone().or(found.station),
            recorded: found.recorded,
        })
    }
}

/// A pattern of file names: text, with `{sensor}`, `{station}`, `{date}` and `{}` for anything.
///
/// A placeholder takes as few signs as it can, and at least one. A name may go on after the end of the pattern only with its ending, such as `.csv`.
///
/// # Examples
/// ```
/// use calibrant_io::{NamePattern, SensorNaming};
/// let naming = SensorNaming { pattern: Some(NamePattern::parse("{station}_{sensor}_{date}")?), ..Default::default() };
/// let named = naming.of("line/L2_A0017_2026-05-01.csv".as_ref())?;
/// assert_eq!((named.sensor.as_str(), named.station.as_deref()), ("A0017", Some("L2")));
/// assert_eq!(named.recorded.unwrap().to_string(), "2026-05-01");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamePattern {
    text: String,
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    Sensor,
    Station,
    Date,
    Anything,
}

#[derive(Default)]
struct Found {
    sensor: Option<String>,
    station: Option<String>,
    recorded: Option<UtcTime>,
}

impl NamePattern {
    /// The pattern of a text.
    ///
    /// # Errors
    /// [`Error::Experiment`] where a placeholder is not known, is there twice, or follows another without a text between them.
    pub fn parse(text: &str) -> Result<Self> {
        let refuse = |what: &str, help: &str| {
            let message = format!("the pattern {text:?} {what}");
            Error::experiment(InputError::new(Refusal::ValueInvalid, message, help))
        };
        let mut parts = Vec::new();
        let mut rest = text;
        while !rest.is_empty() {
            let (before, after) = rest.split_once('{').unwrap_or((rest, ""));
            if !before.is_empty() {
                parts.push(Part::Text(before.to_owned()));
            }
            if before.len() == rest.len() {
                break;
            }
            let (name, after) =
                after.split_once('}').ok_or_else(|| refuse("has a { without a }", "write {sensor}"))?;
            let part = match name {
                "sensor" => Part::Sensor,
                "station" => Part::Station,
                "date" => Part::Date,
                "" => Part::Anything,
                _ => {
                    let help = "placeholders are {sensor}, {station}, {date}, and {} for anything";
                    return Err(refuse(&format!("has the placeholder {{{name}}}"), help));
                }
            };
            if part != Part::Anything && parts.contains(&part) {
                return Err(refuse(&format!("has {{{name}}} twice"), "write {} for one of them"));
            }
            if parts.last().is_some_and(|last| !matches!(last, Part::Text(_))) {
                return Err(refuse("has two placeholders side by side", "write a sign between them"));
            }
            parts.push(part);
            rest = after;
        }
        if !parts.contains(&Part::Sensor) {
            return Err(refuse("does not name the sensor", "write {sensor} where the name has it"));
        }
        Ok(Self { text: text.to_owned(), parts })
    }

    fn find(&self, path: &Path) -> Result<Found> {
        let name = file_name(path);
        let mut found = Found::default();
        if self.matches(&self.parts, &name, &mut found) {
            return Ok(found);
        }
        let message = format!("the name of this file is not of the pattern {:?}", self.text);
        let help =
            "rename it, or change the pattern; a {date} is 2026-05-01 or 20260501, with or without a time";
        Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help).in_file(path)))
    }

    /// Are these parts those of the rest of a name? Each placeholder tries short texts first.
    fn matches(&self, parts: &[Part], name: &str, found: &mut Found) -> bool {
        let Some((part, further)) = parts.split_first() else {
            return name.is_empty() || name.starts_with('.');
        };
        if let Part::Text(text) = part {
            return name.strip_prefix(text.as_str()).is_some_and(|rest| self.matches(further, rest, found));
        }
        let ends = name.char_indices().map(|(start, sign)| start + sign.len_utf8());
        for end in ends {
            let (text, rest) = name.split_at(end);
            let date = UtcTime::parse(text);
            if (*part == Part::Date && date.is_none()) || !self.matches(further, rest, found) {
                continue;
            }
            match part {
                Part::Sensor => found.sensor = Some(text.to_owned()),
                Part::Station => found.station = Some(text.to_owned()),
                Part::Date => found.recorded = date,
                Part::Text(_) | Part::Anything => {}
            }
            return true;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(pattern: &str, file: &str) -> Option<(String, Option<String>, Option<String>)> {
        let pattern = Some(NamePattern::parse(pattern).expect("a pattern"));
        let named = SensorNaming { pattern, ..SensorNaming::default() }.of(file.as_ref()).ok()?;
        Some((named.sensor, named.station, named.recorded.map(|time| time.to_string())))
    }

    #[test]
    fn a_name_is_taken_apart() {
        let text = |text: &str| Some(text.to_owned());
        for (pattern, file, expected) in [
            ("{sensor}", "a/SN1.2026.csv", Some(("SN1", None, None))),
            ("{sensor}_{date}", "SN_1_20260501.csv.gz", Some(("SN_1", None, Some("2026-05-01")))),
            ("{sensor}_{date}", "SN1_20260501_083000.csv", Some(("SN1", None, Some("2026-05-01T08:30:00Z")))),
            ("{station}-{sensor}-{}", "L1-7-x-y.mcap", Some(("7", Some("L1"), None))),
            ("imu_{sensor}.csv", "imu_ü.csv", Some(("ü", None, None))),
            ("imu_{sensor}", "acc_1.csv", None),
            ("{sensor}_{date}", "SN1_20261301.csv", None),
            ("{sensor}", ".csv", Some((".csv", None, None))),
        ] {
            let expected = expected.map(|(sensor, station, date): (&str, Option<&str>, Option<&str>)| {
                (sensor.to_owned(), station.and_then(text), date.and_then(text))
            });
            assert_eq!(named(pattern, file), expected, "{pattern} {file}");
        }
    }

    #[test]
    fn a_wrong_pattern_says_what_is_wrong() {
        for (pattern, says) in [
            ("{serial}", "has the placeholder {serial}"),
            ("{sensor", "has a { without a }"),
            ("{sensor}_{sensor}", "has {sensor} twice"),
            ("{sensor}{date}", "two placeholders side by side"),
            ("{date}", "does not name the sensor"),
            ("", "does not name the sensor"),
        ] {
            let error = NamePattern::parse(pattern).expect_err(pattern).to_string();
            assert!(error.contains(says), "{error}");
        }
    }

    #[test]
    fn without_a_pattern_the_file_names_its_sensor() {
        let naming = SensorNaming::default();
        assert_eq!(naming.of("line/A1.csv".as_ref()).expect("a name").sensor, "A1");
        let given = SensorNaming { sensor: Some("B".into()), ..naming };
        assert_eq!(given.of("line/A1.csv".as_ref()).expect("a name").sensor, "B");
    }
}
