//! The options that name the sensor of a recording, and its station.

use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{NamePattern, SensorNaming};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Which sensor a recording is of.
#[derive(clap::Args)]
pub(super) struct Naming {
    /// The sensor, as calibration.json and the records name it (default: the name of the recording's file without its ending).
    #[arg(long, value_name = "ID", conflicts_with = "sensor_key")]
    sensor: Option<String>,
    /// What the names of the recordings' files say: a text with {sensor}, {station}, {date}, and {} for anything. Example: '{sensor}_{date}'; with folders: '{sensor}/recording'.
    #[arg(long, value_name = "PATTERN")]
    sensor_from: Option<String>,
    /// The recordings name their sensor: by a line '# NAME: …' above the header, or in a column NAME.
    #[arg(long, value_name = "NAME", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    sensor_key: Option<String>,
    /// The station that made the recordings.
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
}

impl Naming {
    /// The options as the session takes them.
    pub(super) fn options(&self) -> calibrant::Result<SensorNaming> {
        let pattern = self.sensor_from.as_deref().map(NamePattern::parse).transpose()?;
        let given = self.sensor.is_some() || self.sensor_key.is_some();
        match &pattern {
            Some(pattern) if pattern.names_sensor() && given => refuse(
                "the sensor is named by an option and by {sensor} in --sensor-from",
                "write {} in place of {sensor}, or leave the option away",
            ),
            Some(pattern) if !pattern.names_sensor() && !given => refuse(
                "the pattern of --sensor-from does not name the sensor",
                "write {sensor} where the name has it, or name the sensor with --sensor",
            ),
            _ => Ok(SensorNaming {
                sensor: self.sensor.clone(),
                key: self.sensor_key.clone(),
                pattern,
                station: self.station.clone(),
            }),
        }
    }

    /// Refuses one name for several recordings, unless their names have dates or stations: then they are of one sensor.
    pub(super) fn check_several(&self) -> calibrant::Result<()> {
        match (&self.sensor, &self.sensor_from) {
            (Some(_), None) => refuse(
                "--sensor names one sensor, and several recordings are given",
                "give --sensor-from '{sensor}_{date}' where they are of several, or --sensor with --sensor-from '{}_{date}' where they are of one",
            ),
            _ => Ok(()),
        }
    }

    /// Refuses recordings that are calibrated together and name different sensors.
    pub(super) fn check_together(&self, recordings: &[PathBuf]) -> calibrant::Result<()> {
        let naming = self.options()?;
        if !naming.names_sensors() {
            return Ok(());
        }
        let mut names = recordings.iter().map(|recording| Ok(naming.of(recording)?.sensor));
        let first: Option<String> = names.next().transpose()?;
        for name in names {
            let name = name?;
            if first.as_ref().is_some_and(|first| *first != name) {
                return refuse(
                    &format!(
                        "--together is for one sensor, and the recordings name {:?} and {name:?}",
                        first.unwrap_or_default()
                    ),
                    "name the sensor with --sensor, or calibrate the recordings one by one",
                );
            }
        }
        Ok(())
    }

    /// Refuses recordings whose sensors nobody has named and whose files have the same name: records would take them for one sensor.
    pub(super) fn check_for_records(&self, recordings: &[PathBuf]) -> calibrant::Result<()> {
        let naming = self.options()?;
        let is_stdin = |recording: &PathBuf| recording.as_os_str() == "-";
        if self.sensor.is_none() && self.sensor_key.is_none() && recordings.iter().any(is_stdin) {
            return refuse(
                "records need the sensor of what comes from standard input",
                "name it with --sensor",
            );
        }
        if naming.names_sensors() {
            return Ok(());
        }
        let mut first: HashMap<String, &Path> = HashMap::new();
        for recording in recordings {
            let sensor = naming.of(recording)?.sensor;
            if let Some(other) = first.insert(sensor.clone(), recording) {
                return refuse(
                    &format!(
                        "{} and {} would be recorded as one sensor {sensor:?}",
                        other.display(),
                        recording.display()
                    ),
                    "name the sensors, for example with --sensor-from '{sensor}/{}' by their folders, or --sensor-from '{}/{sensor}' if they are of one",
                );
            }
        }
        Ok(())
    }
}

fn refuse<T>(what: &str, help: &str) -> calibrant::Result<T> {
    Err(Error::experiment(InputError::new(Refusal::OptionsContradict, what, help)))
}
