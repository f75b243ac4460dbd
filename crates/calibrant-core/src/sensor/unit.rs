//! The units of a sensor's readings, and how they are printed.

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
