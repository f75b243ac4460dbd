//! The line of an experiment file that states the noise of a sensor.

use super::SensorNoise;
use crate::sensor::{ReadingUnit, SensorKind};
use schemars::JsonSchema;
use serde::Serialize;

/// The line of an experiment file that states a sensor's white noise, and its section.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct NoiseLine {
    /// `sensor` for an accelerometer, `gyroscope` for a gyroscope.
    pub section: &'static str,
    /// The line: `noise_counts = [26.3, 27.1, 25.8]`.
    pub line: String,
}

/// The line to paste into an experiment file, in the unit of the readings. `None` where the white noise is
/// not determined on an axis, or is not that of a sensor at rest.
#[must_use]
pub fn noise_line(noise: &SensorNoise) -> Option<NoiseLine> {
    if noise.caveat.is_some() {
        return None;
    }
    let sigma = noise.white_noise_of_readings()?;
    let counts = noise.unit == ReadingUnit::Counts || noise.gain.is_some();
    let unit = if counts { ReadingUnit::Counts } else { noise.unit };
    let section = match noise.sensor_kind {
        SensorKind::Accelerometer => "sensor",
        SensorKind::Gyroscope => "gyroscope",
    };
    // TOML recognises a float by its point
    let digits = |value: f64| format!("{value:.3e}").parse::<f64>().map(|rounded| format!("{rounded:?}"));
    let values: Vec<String> =
        noise.axes.iter().filter_map(|axis| digits(sigma[axis.axis.index()]).ok()).collect();
    Some(NoiseLine { section, line: format!("noise_{} = [{}]", unit.suffix(), values.join(", ")) })
}
