//! Options for reading a calibration.

use super::format::ImuFormat;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// The unit of the readings, where a file does not state it.
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

/// Options for reading a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ConventionOptions {
    /// The format; the content decides where it is not given.
    pub format: Option<ImuFormat>,
    /// Unit of the readings, for files that do not state it.
    pub units: Option<RawUnits>,
    /// The sensor, for files of one sensor that do not name it.
    pub sensor_kind: Option<SensorKind>,
}
