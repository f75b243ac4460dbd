//! The two sensors of an IMU, their axes, and the units of their readings.

use std::fmt;

/// One of the two sensors of an IMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SensorKind {
    /// Specific force.
    Accelerometer,
    /// Angular rate.
    Gyroscope,
}

impl SensorKind {
    /// All.
    pub const ALL: [Self; 2] = [Self::Accelerometer, Self::Gyroscope];

    /// `accelerometer` or `gyroscope`: how names of parameters begin.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Accelerometer => "accelerometer",
            Self::Gyroscope => "gyroscope",
        }
    }

    /// Unit of its stimulus: m/s² or rad/s.
    #[must_use]
    pub fn stimulus_unit(self) -> ReadingUnit {
        match self {
            Self::Accelerometer => ReadingUnit::MetrePerSecondSquared,
            Self::Gyroscope => ReadingUnit::RadianPerSecond,
        }
    }
}

impl fmt::Display for SensorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

crate::json_name!(SensorKind, SensorKind::ALL);

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

/// Unit of a sensor's readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadingUnit {
    /// Metres per second squared, of an accelerometer.
    MetrePerSecondSquared,
    /// Radians per second, of a gyroscope.
    RadianPerSecond,
    /// Raw counts of the analogue-to-digital converter.
    Counts,
}

impl ReadingUnit {
    /// Every unit.
    pub const ALL: [Self; 3] = [Self::MetrePerSecondSquared, Self::RadianPerSecond, Self::Counts];

    /// As it is printed: `m/s²`, `rad/s` or `counts`.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::RadianPerSecond => "rad/s",
            Self::Counts => "counts",
        }
    }

    /// As it ends a column's name: `mps2`, `radps` or `counts`.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "mps2",
            Self::RadianPerSecond => "radps",
            Self::Counts => "counts",
        }
    }
}

crate::json_name!(ReadingUnit: symbol, ReadingUnit::ALL);
