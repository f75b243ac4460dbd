//! Which sensor a recording is of, and when and where it was made: by options, by the path of its file, or by the recording itself.

use super::name_pattern::{FoundNames, NamePattern};
use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_recording::files::utc_time::UtcTime;
use calibrant_recording::sensor_named_in;
use std::path::Path;

/// How recordings name their sensor.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SensorNaming {
    /// The sensor, where all recordings are of one.
    pub sensor: Option<String>,
    /// What names the sensor in the text of a recording: a line `# NAME: value` above the header, or a column.
    pub key: Option<String>,
    /// What the path of a recording's file says.
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
    /// Checks that exactly one of its parts names the sensor, where there is a pattern.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the pattern and another part name it, or neither.
    pub fn check(&self) -> Result<()> {
        let (sensor, from) = (TaskOption::Sensor, TaskOption::SensorFrom);
        let given = self.sensor.is_some() || self.key.is_some();
        let (message, help) = match self.pattern.as_ref().map(NamePattern::names_sensor) {
            Some(true) if given => (
                format!("the sensor is named by an option and by {{sensor}} in {from}"),
                "write {} in place of {sensor}, or leave the option away".to_owned(),
            ),
            Some(false) if !given => (
                format!("the pattern of {from} does not name the sensor"),
                format!("write {{sensor}} where the name has it, or name the sensor with {sensor}"),
            ),
            _ => return Ok(()),
        };
        Err(Error::experiment(InputError::new(Refusal::OptionsContradict, message, help)))
    }

    /// What is named of a recording. Where nothing names its sensor, it has the name of the file without its ending, and `stdin` where it comes from standard input.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the path is not of the pattern, or a name has no letter or digit, or has blanks at its ends, line ends or tabs. [`Error::Recording`] where the recording
    /// is no text that names its sensor by [`key`](Self::key).
    pub fn of(&self, recording: &Path) -> Result<NamedRecording> {
        let found = match &self.pattern {
            Some(pattern) => pattern.find(recording)?,
            None => FoundNames::default(),
        };
        let named = match (&self.sensor, &self.key) {
            (Some(sensor), _) => Some(sensor.clone()),
            (None, Some(key)) => Some(sensor_named_in(recording, key)?),
            (None, None) => found.sensor,
        };
        let station = self.station.clone().or(found.station);
        named.iter().try_for_each(|sensor| check_name(sensor, "sensor", recording))?;
        station.iter().try_for_each(|station| check_name(station, "station", recording))?;
        let sensor = named.unwrap_or_else(|| default_name(recording));
        Ok(NamedRecording { sensor, station, recorded: found.recorded })
    }

    /// Does the user name the sensors?
    #[must_use]
    pub fn names_sensors(&self) -> bool {
        let in_pattern = self.pattern.as_ref().is_some_and(NamePattern::names_sensor);
        self.sensor.is_some() || self.key.is_some() || in_pattern
    }
}

fn default_name(recording: &Path) -> String {
    match recording.file_stem() {
        Some(stem) if stem != "-" => stem.to_string_lossy().replace(char::is_control, "_"),
        _ => "stdin".to_owned(),
    }
}

/// Names stand in tables, with one line for each sensor.
fn check_name(name: &str, of: &str, recording: &Path) -> Result<()> {
    if name.contains(char::is_alphanumeric) && name.trim() == name && !name.contains(char::is_control) {
        return Ok(());
    }
    let message = format!("{name:?} is no name of a {of}");
    let help =
        "a name has at least one letter or digit, no blanks at its ends, and neither line ends nor tabs";
    Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help).in_file(recording)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_pattern_the_file_names_its_sensor() {
        let naming = SensorNaming::default();
        assert_eq!(naming.of("line/A1.csv".as_ref()).expect("a name").sensor, "A1");
        assert_eq!(naming.of("-".as_ref()).expect("a name").sensor, "stdin");
        let given = SensorNaming { sensor: Some("B".into()), ..naming };
        assert_eq!(given.of("line/A1.csv".as_ref()).expect("a name").sensor, "B");
    }

    #[test]
    fn a_sensor_that_is_given_has_the_date_of_the_file() {
        let pattern = Some(NamePattern::parse("rest_{date}").expect("a pattern"));
        let naming = SensorNaming { sensor: Some("B".into()), pattern, ..SensorNaming::default() };
        let named = naming.of("rest_2026-05-01.csv".as_ref()).expect("a name");
        assert_eq!((named.sensor.as_str(), named.recorded), ("B", UtcTime::parse("2026-05-01")));
    }

    #[test]
    fn a_name_is_one_line() {
        for name in ["", " ", "A\n1", "A\t1", "..", "-", " A1"] {
            let naming = SensorNaming { sensor: Some(name.into()), ..SensorNaming::default() };
            assert!(naming.of("A.csv".as_ref()).is_err(), "{name:?}");
        }
    }

    #[test]
    fn the_recording_names_its_sensor() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("recording.csv");
        let rows = "t_s,ax_mps2,ay_mps2,az_mps2,Serial\n0,0,0,9.8,SN 17\n0.01,0,0,9.8,SN 17\n";
        std::fs::write(&path, format!("# device: SN 18\n# made by hand\n{rows}")).expect("written");
        let of = |key: &str| {
            let naming = SensorNaming { key: Some(key.into()), ..SensorNaming::default() };
            naming.of(&path).map(|named| named.sensor)
        };
        assert_eq!(
            (of("device").expect("a line"), of("serial").expect("a column")),
            ("SN 18".into(), "SN 17".into())
        );
        assert_eq!(of("Device").expect("a line"), "SN 18");
        let error = of("station").expect_err("not there").to_string();
        assert!(error.contains("\"station\""), "{error}");
        std::fs::write(&path, format!("# serial: SN 18\n{rows}")).expect("written");
        let error = of("serial").expect_err("two names").to_string();
        assert!(error.contains("names two sensors by \"serial\": \"SN 18\" and \"SN 17\""), "{error}");
        std::fs::write(&path, [0_u8; 9]).expect("written");
        of("serial").expect_err("no text");
    }
}
