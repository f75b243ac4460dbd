//! What the path of a recording's file says of its sensor, its station and its date.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_recording::files::utc_time::UtcTime;
use std::path::Path;

/// A pattern of file names: text, with `{sensor}`, `{station}`, `{date}` and `{}` for anything. With slashes, it is one of paths: `{sensor}/recording`.
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

/// What a path says.
#[derive(Default)]
pub(crate) struct FoundNames {
    pub(crate) sensor: Option<String>,
    pub(crate) station: Option<String>,
    pub(crate) recorded: Option<UtcTime>,
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
        if !parts.iter().any(|part| matches!(part, Part::Sensor | Part::Station | Part::Date)) {
            return Err(refuse("names nothing", "write {sensor} where the name has the sensor"));
        }
        Ok(Self { text: text.to_owned(), parts })
    }

    /// Does it say where the sensor stands?
    #[must_use]
    pub fn names_sensor(&self) -> bool {
        self.parts.contains(&Part::Sensor)
    }

    pub(crate) fn find(&self, path: &Path) -> Result<FoundNames> {
        let mut names: Vec<_> = path.iter().map(|name| name.to_string_lossy()).collect();
        let folders = self.text.matches('/').count();
        let name = names.split_off(names.len().saturating_sub(folders + 1)).join("/");
        let mut found = FoundNames::default();
        if self.matches(&self.parts, &name, &mut found) {
            return Ok(found);
        }
        let message = format!(
            "the {} of this file is not of the pattern {:?}",
            if folders > 0 { "path" } else { "name" },
            self.text
        );
        let help =
            "rename it, or change the pattern; a {date} is 2026-05-01 or 20260501, with or without a time";
        Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help).in_file(path)))
    }

    /// Are these parts those of the rest of a name? Each placeholder tries short texts first.
    fn matches(&self, parts: &[Part], name: &str, found: &mut FoundNames) -> bool {
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
        let pattern = NamePattern::parse(pattern).expect("a pattern");
        let named = pattern.find(file.as_ref()).ok()?;
        Some((named.sensor?, named.station, named.recorded.map(|time| time.to_string())))
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
            ("{sensor}/recording", "line/SN1/recording.csv", Some(("SN1", None, None))),
            ("{station}/{sensor}/{}", "L1/SN1/x.csv", Some(("SN1", Some("L1"), None))),
            ("{station}/{sensor}/{}", "SN1/x.csv", None),
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
            ("{}", "names nothing"),
            ("", "names nothing"),
        ] {
            let error = NamePattern::parse(pattern).expect_err(pattern).to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
