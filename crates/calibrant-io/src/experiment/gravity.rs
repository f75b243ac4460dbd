//! Gravity: its magnitude, or the latitude and the height that give it. Without any of them it is that of somewhere on the Earth.

use super::number::Within;
use super::ranges::{GravitySd, Height, Latitude};
use super::refused_key::{missing, refused};
use calibrant_core::error::Result;
use calibrant_core::motion::Gravity;

/// Gravity, from the keys of this section: a magnitude with its standard uncertainty, or latitude and height, or the latitude alone. Beside
/// a magnitude a latitude may serve for the Earth's rate.
pub(super) fn gravity_of(
    section: &str,
    (magnitude, sd): (Option<f64>, Option<Within<GravitySd>>),
    (latitude, height): (Option<Within<Latitude>>, Option<Within<Height>>),
    with_earth_rate: bool,
) -> Result<Gravity> {
    /// The remedy for missing or contradictory gravity.
    const HELP: &str = "give gravity_mps2, or latitude_deg and height_m";
    let key = |key: &str| format!("{section}.{key}");
    let sd = sd.map(f64::from);
    let (latitude, height) = (latitude.map(f64::from), height.map(f64::from));
    let twice = |at: &str, more: &str| {
        Err(refused(key(at), "gravity is given twice", format!("{HELP}, not both{more}")))
    };
    match (magnitude, latitude, height) {
        (Some(_), Some(_), _) if !with_earth_rate => twice("latitude_deg", ""),
        (Some(_), _, Some(_)) if with_earth_rate => {
            twice("height_m", "; latitude_deg alone may stand beside it, for the Earth's rate")
        }
        (Some(_), _, Some(_)) => twice("height_m", ""),
        (Some(magnitude_mps2), _, None) => Ok(Gravity { magnitude_mps2, sd_mps2: sd.unwrap_or(0.0) }),
        (None, None, Some(_)) => Err(missing(key("latitude_deg"), "height_m goes with latitude_deg")),
        (None, None, None) if sd.is_some() => Err(missing(key("gravity_mps2"), HELP)),
        (None, place, height) => {
            let gravity = match (place, height) {
                (Some(latitude), Some(height)) => Gravity::from_latitude(latitude, height),
                (Some(latitude), None) => Gravity::at_latitude(latitude),
                (None, _) => Gravity::SOMEWHERE,
            };
            Ok(Gravity { sd_mps2: sd.unwrap_or(gravity.sd_mps2), ..gravity })
        }
    }
}
