//! The options that name the sensor of a recording, and its station.

use calibrant::io::{NamePattern, SensorNaming};

/// Which sensor a recording is of.
#[derive(clap::Args)]
pub(super) struct Naming {
    /// The sensor, as calibration.json and the records name it (default: the name of the recording's file without its ending).
    #[arg(long, value_name = "ID", conflicts_with = "sensor_from")]
    pub(super) sensor: Option<String>,
    /// What the names of the recordings' files say: a text with {sensor}, {station}, {date}, and {} for anything. Example: '{sensor}_{date}'.
    #[arg(long, value_name = "PATTERN")]
    sensor_from: Option<String>,
    /// The station that made the recordings.
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
}

impl Naming {
    /// The options as the pipeline takes them.
    pub(super) fn options(&self) -> calibrant::Result<SensorNaming> {
        Ok(SensorNaming {
            sensor: self.sensor.clone(),
            pattern: self.sensor_from.as_deref().map(NamePattern::parse).transpose()?,
            station: self.station.clone(),
        })
    }
}
