//! The columns of a file: the meaning of each, and why it is used or not.

use super::unit::ColumnUnit;
use calibrant_core::json_object;
use calibrant_core::sensor::{Axis, SensorKind};
use std::fmt;

/// The content of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnMeaning {
    /// Sample times.
    Time,
    /// Ticks since the whole second that the column of times has.
    RestOfSecond,
    /// Another clock: it gives the times where no column of sample times says its unit.
    Clock,
    /// A number that counts samples, lost ones included.
    Counter,
    /// Readings of one axis.
    Reading(SensorKind, Axis),
    /// Temperature of the sensor.
    Temperature,
    /// Acceleration from which a filter has taken gravity: no reading of a sensor.
    GravityRemoved,
    /// Orientation that a filter computed.
    Orientation,
    /// Increments of velocity or orientation over a sample.
    Increment,
    /// Magnetic field.
    Magnetometer,
    /// Date and time of day.
    Calendar,
    /// Something else, or unknown.
    Other,
}

impl fmt::Display for ColumnMeaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => f.write_str("time"),
            Self::RestOfSecond => f.write_str("time within the second"),
            Self::Clock => f.write_str("another clock"),
            Self::Counter => f.write_str("sample counter"),
            Self::Reading(sensor_kind, axis) => write!(f, "{sensor_kind} {axis}"),
            Self::Temperature => f.write_str("temperature"),
            Self::GravityRemoved => f.write_str("acceleration without gravity"),
            Self::Orientation => f.write_str("orientation"),
            Self::Increment => f.write_str("increment"),
            Self::Magnetometer => f.write_str("magnetic field"),
            Self::Calendar => f.write_str("date or time of day"),
            Self::Other => f.write_str("unknown"),
        }
    }
}

impl ColumnMeaning {
    /// Why columns of this meaning are never used; `None` where they are.
    pub(super) fn never_used(self) -> Option<&'static str> {
        match self {
            Self::GravityRemoved => Some("gravity has been removed: no reading of a sensor"),
            Self::Orientation => Some("computed by a filter: no reading of a sensor"),
            Self::Increment => Some("increments of a strapdown integration, not readings"),
            Self::Magnetometer => Some("the magnetometer is not calibrated"),
            Self::Calendar => Some("the time of day is not needed"),
            Self::Clock => Some("the sample times are in another column"),
            Self::Other => Some("not known to be needed"),
            Self::Time | Self::RestOfSecond | Self::Counter | Self::Reading(..) | Self::Temperature => None,
        }
    }
}

/// A column of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuColumn {
    /// Its name; its number, from 1, in a file without a header.
    pub name: String,
    /// Its content.
    pub meaning: ColumnMeaning,
    /// Its unit in the file, where it is known.
    pub unit: Option<ColumnUnit>,
    /// Why it is not used; `None` where it is.
    pub unused: Option<String>,
}

impl ImuColumn {
    pub(super) fn new(name: &str, meaning: ColumnMeaning, unit: Option<ColumnUnit>) -> Self {
        Self { name: name.to_owned(), meaning, unit, unused: meaning.never_used().map(ToOwned::to_owned) }
    }

    /// Is it used?
    #[must_use]
    pub fn is_used(&self) -> bool {
        self.unused.is_none()
    }
}

json_object! {
    ImuColumn as column {
        /// The name in the file.
        name: &column.name,
        /// What it was read as.
        meaning: column.meaning.to_string(),
        /// Its unit, where it is known.
        unit: column.unit.map(ColumnUnit::symbol),
        /// Is it read?
        used: column.is_used(),
        /// Why it is not read.
        not_used_because: column.unused.as_deref(),
    }
}
