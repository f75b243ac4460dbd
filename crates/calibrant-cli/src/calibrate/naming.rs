//! The options that name the sensor of a recording, and its station.

use calibrant::io::{NamePattern, SensorNaming};

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
        Ok(SensorNaming {
            sensor: self.sensor.clone(),
            key: self.sensor_key.clone(),
            pattern: self.sensor_from.as_deref().map(NamePattern::parse).transpose()?,
            station: self.station.clone(),
        })
    }
}
