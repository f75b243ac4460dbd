//! The axes of a sensor: x, y, z.

use std::fmt;

/// One axis of a sensor. A uniaxial sensor has only [`Axis::X`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// All axes, in order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// Position in a vector: 0, 1, 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// The letter: `x`, `y`, `z`.
    #[must_use]
    pub fn letter(self) -> char {
        ['x', 'y', 'z'][self.index()]
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.letter())
    }
}

crate::json_name!(Axis: letter, Axis::ALL);
