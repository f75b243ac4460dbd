//! A direction in an experiment file.

use super::number::{Either, Within};
use super::ranges::DirectionComponent;
use super::refused_key::refused;
use super::remedies::DIRECTION;
use calibrant_core::error::Result;
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;

/// A direction: `"x"`, `"-z"`, or three numbers.
pub type Direction = Either<String, Vec<Within<DirectionComponent>>>;

/// The unit vector of a direction.
pub(super) fn unit_vector(key: &str, direction: &Direction) -> Result<Vector3<f64>> {
    match direction {
        Either::Single(text) => {
            let (sign, name) = text.strip_prefix('-').map_or((1.0, text.as_str()), |name| (-1.0, name));
            let name = name.strip_prefix('+').unwrap_or(name);
            match Axis::ALL.iter().position(|axis| axis.to_string() == name) {
                Some(axis) => Ok(Vector3::from_fn(|k, _| if k == axis { sign } else { 0.0 })),
                None => Err(refused(key, format!("\"{text}\" is no direction"), DIRECTION)),
            }
        }
        Either::Compound(numbers) => {
            let [x, y, z] = numbers.as_slice() else {
                let message = format!("a direction has three numbers, this has {}", numbers.len());
                return Err(refused(key, message, DIRECTION));
            };
            let vector = Vector3::new(x.get(), y.get(), z.get());
            vector.try_normalize(1e-9).ok_or_else(|| refused(key, "a direction of no length", DIRECTION))
        }
    }
}

/// The unit vectors of a list of directions.
pub(super) fn unit_vectors(key: &str, directions: &[Direction]) -> Result<Vec<Vector3<f64>>> {
    directions.iter().enumerate().map(|(i, of)| unit_vector(&format!("{key}[{i}]"), of)).collect()
}
