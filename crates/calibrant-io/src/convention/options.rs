//! How a calibration is read.

use super::format::ImuFormat;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// What the readings are, where a file does not say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RawUnits {
    /// m/s² and rad/s.
    Si,
    /// Counts.
    Counts,
}

impl RawUnits {
    /// The unit of a sensor's readings.
    #[must_use]
    pub fn unit(self, sensor_kind: SensorKind) -> ReadingUnit {
        match self {
            Self::Si => sensor_kind.stimulus_unit(),
            Self::Counts => ReadingUnit::Counts,
        }
    }
}

/// How a calibration is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ConventionOptions {
    /// The format; by content where it is not given.
    pub format: Option<ImuFormat>,
    /// Unit of the readings, for files that do not say.
    pub units: Option<RawUnits>,
    /// The sensor, for files of one sensor that do not say which.
    pub sensor_kind: Option<SensorKind>,
}
