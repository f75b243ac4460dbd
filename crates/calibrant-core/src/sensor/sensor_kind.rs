//! The two sensors of an IMU.

use super::ReadingUnit;
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
    /// Both.
    pub const ALL: [Self; 2] = [Self::Accelerometer, Self::Gyroscope];

    /// `accelerometer` or `gyroscope`: how names of parameters begin.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Accelerometer => "accelerometer",
            Self::Gyroscope => "gyroscope",
        }
    }

    /// The other sensor of an IMU.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Accelerometer => Self::Gyroscope,
            Self::Gyroscope => Self::Accelerometer,
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
