//! A direction in an experiment file.

use super::number::{Either, Within};
use super::ranges::DirectionComponent;
use super::remedies::DIRECTION;
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// A direction as it is written: `"x"`, `"-z"`, or three numbers of any length.
pub type WrittenDirection = Either<String, Vec<Within<DirectionComponent>>>;

/// A direction: `"x"`, `"-z"`, or three numbers. In code it is made with `try_from`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WrittenDirection", into = "WrittenDirection")]
pub struct Direction {
    written: WrittenDirection,
    unit: Vector3<f64>,
}

impl Direction {
    /// Its unit vector.
    #[must_use]
    pub fn unit(&self) -> Vector3<f64> {
        self.unit
    }
}

impl From<Direction> for WrittenDirection {
    fn from(direction: Direction) -> Self {
        direction.written
    }
}

impl TryFrom<WrittenDirection> for Direction {
    type Error = String;

    fn try_from(written: WrittenDirection) -> Result<Self, String> {
        let refused = |message: &str| Err(format!("{message}\n{DIRECTION}"));
        let unit = match &written {
            Either::Single(text) => {
                let (sign, name) = text.strip_prefix('-').map_or((1.0, text.as_str()), |name| (-1.0, name));
                let name = name.strip_prefix('+').unwrap_or(name);
                match Axis::ALL.iter().position(|axis| axis.to_string() == name) {
                    Some(axis) => Vector3::from_fn(|k, _| if k == axis { sign } else { 0.0 }),
                    None => return refused(&format!("\"{text}\" is no direction")),
                }
            }
            Either::Compound(numbers) => {
                let [x, y, z] = numbers.as_slice() else {
                    return refused(&format!("a direction has three numbers, this has {}", numbers.len()));
                };
                match Vector3::new(x.get(), y.get(), z.get()).try_normalize(1e-9) {
                    Some(unit) => unit,
                    None => return refused("a direction of no length"),
                }
            }
        };
        Ok(Self { written, unit })
    }
}
