//! Reads the keys of `[design]` that are about poses: what is known of their directions, and which are allowed.

use super::direction::direction;
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::error::Result;
use calibrant_design::poses::Allowed;

/// Range of the angle around an allowed direction.
const WITHIN: Bounds = Bounds::from(0.0, 90.0, "degrees");

/// What a design of poses may choose from.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseOptions {
    /// Will the directions of the holds be known when the sensor is calibrated?
    pub known: bool,
    /// The directions that a pose may have.
    pub allowed: Allowed,
}

impl Default for PoseOptions {
    fn default() -> Self {
        Self { known: false, allowed: Allowed::Anywhere }
    }
}

/// Reads `directions`, `allowed` and `within_deg`.
pub(super) fn read(section: &Section<'_>) -> Result<PoseOptions> {
    let known = section
        .get("directions")
        .map_or(Ok(false), |entry| entry.word(&[("unknown", false), ("known", true)]))?;
    let within = section.get("within_deg").map(|entry| entry.number(&WITHIN)).transpose()?;
    let allowed = section.get("allowed").map_or(Ok(Allowed::Anywhere), |entry| read_allowed(&entry))?;
    let allowed = match (allowed, within.filter(|degrees| *degrees > 0.0)) {
        (Allowed::Of(list), Some(degrees)) => Allowed::Near(list, degrees.to_radians()),
        (allowed, _) => allowed,
    };
    Ok(PoseOptions { known, allowed })
}

fn read_allowed(entry: &Entry<'_>) -> Result<Allowed> {
    /// The remedy for wrong directions.
    const HELP: &str = "\"any\", \"faces\" (6 of a cube), \"edges\" (18, with the faces), \"corners\" (26, with both), or a list: [\"x\", \"-z\", [0.0, 0.6, 0.8]]";
    if entry.text().is_some() {
        let cube = entry.word(&[
            ("any", None),
            ("faces", Some((false, false))),
            ("edges", Some((true, false))),
            ("corners", Some((true, true))),
        ])?;
        return Ok(cube.map_or(Allowed::Anywhere, |(edges, corners)| Allowed::cube(edges, corners)));
    }
    let list = entry.items(HELP)?.iter().map(direction).collect::<Result<Vec<_>>>()?;
    if list.is_empty() {
        return Err(entry.reject("no direction is allowed", HELP));
    }
    Ok(Allowed::Of(list))
}
