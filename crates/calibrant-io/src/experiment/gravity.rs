//! Reads gravity: its magnitude, or the latitude and the height that give it.

use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::motion::Gravity;

/// Least and largest magnitude of gravity, m/s².
pub(super) const LEAST: f64 = 0.1;
pub(super) const LARGEST: f64 = 100.0;
/// Range of gravity.
const GRAVITY: Bounds = Bounds::from(LEAST, LARGEST, "m/s²");
/// Range of the standard uncertainty of gravity.
pub(super) const GRAVITY_SD: Bounds = Bounds::from(0.0, 1.0, "m/s²");
/// Range of the latitude.
pub(super) const LATITUDE: Bounds = Bounds::from(-90.0, 90.0, "degrees");
/// Range of the height above the sea.
const HEIGHT: Bounds = Bounds::from(-12_000.0, 100_000.0, "m");

/// Reads the magnitude of gravity and says where it is from. Beside a value a latitude may serve for the Earth's rate.
pub(super) fn read_gravity(section: &Section<'_>, with_earth_rate: bool) -> Result<(Gravity, String)> {
    /// The remedy for missing or contradictory gravity.
    const HELP: &str = "give gravity_mps2, or latitude_deg and height_m";
    let sd = section.get("gravity_sd_mps2").map(|entry| entry.number(&GRAVITY_SD)).transpose()?;
    let (given, latitude, height) =
        (section.get("gravity_mps2"), section.get("latitude_deg"), section.get("height_m"));
    match (given, latitude, height) {
        (Some(_), Some(entry), _) if !with_earth_rate => {
            Err(entry.reject("gravity is given twice", format!("{HELP}, not both")))
        }
        (Some(_), _, Some(entry)) => {
            let help = if with_earth_rate {
                "; latitude_deg alone may stand beside it, for the Earth's rate"
            } else {
                ""
            };
            Err(entry.reject("gravity is given twice", format!("{HELP}, not both{help}")))
        }
        (Some(entry), _, None) => {
            let gravity = Gravity { magnitude_mps2: entry.number(&GRAVITY)?, sd_mps2: sd.unwrap_or(0.0) };
            Ok((gravity, "given".into()))
        }
        (None, Some(latitude), Some(height)) => {
            let (latitude, height) = (latitude.number(&LATITUDE)?, height.number(&HEIGHT)?);
            let mut gravity = Gravity::from_latitude(latitude, height);
            if let Some(sd) = sd {
                gravity.sd_mps2 = sd;
            }
            Ok((gravity, format!("from latitude {latitude}°, height {height} m")))
        }
        (None, Some(_), None) => Err(section.missing("height_m", "latitude_deg and height_m go together")),
        (None, None, Some(_)) => {
            Err(section.missing("latitude_deg", "latitude_deg and height_m go together"))
        }
        (None, None, None) => Err(section.missing("gravity_mps2", HELP)),
    }
}
