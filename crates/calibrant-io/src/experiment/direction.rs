//! Reads a direction in an experiment file.

use super::number_range::Bounds;
use super::toml_document::Entry;
use calibrant_core::error::Result;
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;

/// Range of a component of a direction.
const COMPONENT: Bounds = Bounds::from(-1e3, 1e3, "");

/// A direction: `"x"`, `"-z"`, or three numbers.
pub(super) fn direction(entry: &Entry<'_>) -> Result<Vector3<f64>> {
    /// The remedy for a wrong direction.
    const HELP: &str = "\"x\", \"-x\", …, or three numbers: [0.0, 0.6, 0.8]";
    if let Some(text) = entry.text() {
        let (sign, name) = text.strip_prefix('-').map_or((1.0, text), |name| (-1.0, name));
        let name = name.strip_prefix('+').unwrap_or(name);
        return match Axis::ALL.iter().position(|axis| axis.to_string() == name) {
            Some(axis) => Ok(Vector3::from_fn(|k, _| if k == axis { sign } else { 0.0 })),
            None => Err(entry.reject(format!("\"{text}\" is no direction"), HELP)),
        };
    }
    let items = entry.items(HELP)?;
    let [x, y, z] = items.as_slice() else {
        return Err(entry.reject(format!("a direction has three numbers, this has {}", items.len()), HELP));
    };
    let vector = Vector3::new(x.number(&COMPONENT)?, y.number(&COMPONENT)?, z.number(&COMPONENT)?);
    vector.try_normalize(1e-9).ok_or_else(|| entry.reject("a direction of no length", HELP))
}
