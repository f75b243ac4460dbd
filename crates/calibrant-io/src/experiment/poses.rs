//! The keys of `[design]` that are about poses: what is known of their directions, and which are allowed.

use super::direction::Direction;
use super::number::{Either, Within};
use super::ranges::Cone;
use super::refused_key::refused;
use super::remedies::remedy;
use calibrant_core::error::Result;
use calibrant_design::poses::Allowed;
use serde::{Deserialize, Serialize};

/// What will be known of the directions of the holds when the sensor is calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DirectionsAre {
    /// Only gravity.
    Unknown,
    /// The directions.
    Known,
}

/// Directions of a cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CubeDirections {
    /// All directions.
    Any,
    /// Its 6 faces.
    Faces,
    /// 18, with the edges.
    Edges,
    /// 26, with the corners.
    Corners,
}

/// The directions that a pose may have: a word, or a list.
pub type AllowedDirections = Either<CubeDirections, Vec<Direction>>;

/// The directions that a pose may have.
pub(super) fn allowed(of: Option<&AllowedDirections>, within: Option<Within<Cone>>) -> Result<Allowed> {
    let allowed = match of {
        None | Some(Either::Single(CubeDirections::Any)) => Allowed::Anywhere,
        Some(Either::Single(CubeDirections::Faces)) => Allowed::cube(false, false),
        Some(Either::Single(CubeDirections::Edges)) => Allowed::cube(true, false),
        Some(Either::Single(CubeDirections::Corners)) => Allowed::cube(true, true),
        Some(Either::Compound(list)) if list.is_empty() => {
            return Err(refused("design.allowed", "no direction is allowed", remedy("design.allowed")));
        }
        Some(Either::Compound(list)) => Allowed::Of(list.iter().map(Direction::unit).collect()),
    };
    Ok(match (allowed, within.map_or(0.0, f64::from)) {
        (Allowed::Of(list), degrees) if degrees > 0.0 => Allowed::Near(list, degrees.to_radians()),
        (allowed, _) => allowed,
    })
}
