//! The units in which files give readings.

use super::sensitivity::{STANDARD_GRAVITY_MPS2, Sensitivity};
use crate::recording::time_unit::TimeUnit;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// Unit of an accelerometer's or a gyroscope's readings as a file gives them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImuUnit {
    /// Metres per second squared.
    MetrePerSecondSquared,
    /// Millimetres per second squared; converted to m/s².
    MillimetrePerSecondSquared,
    /// Standard gravity, 9.80665 m/s²; converted to m/s².
    StandardGravity,
    /// Thousandths of standard gravity; converted to m/s².
    MilliGravity,
    /// Radians per second.
    RadianPerSecond,
    /// Degrees per second; converted to rad/s.
    DegreePerSecond,
    /// Thousandths of a degree per second; converted to rad/s.
    MilliDegreePerSecond,
    /// Raw counts of the analogue-to-digital converter, of either sensor.
    Counts,
    /// Raw counts of a known sensitivity; converted to m/s² or rad/s.
    CountsOf(Sensitivity),
}

impl ImuUnit {
    /// All units; counts of a known sensitivity are counts.
    pub const ALL: [Self; 8] = [
        Self::MetrePerSecondSquared,
        Self::MillimetrePerSecondSquared,
        Self::StandardGravity,
        Self::MilliGravity,
        Self::RadianPerSecond,
        Self::DegreePerSecond,
        Self::MilliDegreePerSecond,
        Self::Counts,
    ];

    /// As it is printed: `m/s²`, `mm/s²`, `g`, `mg`, `rad/s`, `deg/s`, `mdps` or `counts`.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::MillimetrePerSecondSquared => "mm/s²",
            Self::StandardGravity => "g",
            Self::MilliGravity => "mg",
            Self::RadianPerSecond => "rad/s",
            Self::DegreePerSecond => "deg/s",
            Self::MilliDegreePerSecond => "mdps",
            Self::Counts | Self::CountsOf(_) => "counts",
        }
    }

    /// The unit of this name in one of its usual spellings: `m/s²`, `m/s^2`, `mps2`, `m s^-2`, `mm/s²`, `g`, `mg`,
    /// `rad/s`, `radps`, `deg/s`, `dps`, `°/s`, `mdps`, `counts`, `LSB`, …; or a sensitivity as datasheets have it, `16384 LSB/g`, `8.75 mdps/LSB`.
    ///
    /// # Examples
    /// ```
    /// use calibrant_recording::ImuUnit;
    /// assert_eq!(ImuUnit::parse("m s^-2"), Some(ImuUnit::MetrePerSecondSquared));
    /// assert_eq!(ImuUnit::parse("dps"), Some(ImuUnit::DegreePerSecond));
    /// assert_eq!(ImuUnit::parse("furlongs"), None);
    /// ```
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.to_lowercase().replace(" per ", "/");
        let plain: String = text.chars().filter(|c| !" _^*·()".contains(*c)).collect();
        Some(match plain.as_str() {
            "m/s²" | "m/s2" | "mps2" | "ms2" | "ms-2" | "mpss" | "m/s/s" | "meterspersecondsquared" => {
                Self::MetrePerSecondSquared
            }
            "mm/s²" | "mm/s2" | "mmps2" | "mms2" | "mms-2" | "mm/s/s" => Self::MillimetrePerSecondSquared,
            "g" | "gs" | "gee" => Self::StandardGravity,
            "mg" | "millig" => Self::MilliGravity,
            "rad/s" | "radps" | "rads" | "rads-1" | "radpersecond" | "rad/sec" => Self::RadianPerSecond,
            "deg/s" | "degps" | "dps" | "degs" | "degs-1" | "°/s" | "deg/sec" | "degpersecond" => {
                Self::DegreePerSecond
            }
            "mdps" | "mdeg/s" | "mdegps" | "m°/s" => Self::MilliDegreePerSecond,
            "counts" | "count" | "cnt" | "lsb" | "raw" | "adc" | "digit" | "digits" => Self::Counts,
            _ => return sensitivity(&plain).map(Self::CountsOf),
        })
    }

    /// Counts of which this number is one of another unit; `None` where that is no sensitivity.
    ///
    /// # Examples
    /// ```
    /// use calibrant_recording::ImuUnit;
    /// assert_eq!(ImuUnit::of_counts(131.0, ImuUnit::DegreePerSecond), ImuUnit::parse("131 LSB/dps"));
    /// assert_eq!(ImuUnit::of_counts(0.0, ImuUnit::DegreePerSecond), None);
    /// ```
    #[must_use]
    pub fn of_counts(number: f64, of: Self) -> Option<Self> {
        let (reading_unit, size) = of.reading();
        let sensor_kind = SensorKind::ALL.into_iter().find(|kind| kind.stimulus_unit() == reading_unit)?;
        Sensitivity::new(sensor_kind, number / size).map(Self::CountsOf)
    }

    /// The sensitivity, where it is known.
    #[must_use]
    pub fn sensitivity(self) -> Option<Sensitivity> {
        match self {
            Self::CountsOf(sensitivity) => Some(sensitivity),
            _ => None,
        }
    }

    /// Can this sensor's readings have it?
    #[must_use]
    pub fn suits(self, sensor_kind: SensorKind) -> bool {
        match self {
            Self::MetrePerSecondSquared
            | Self::MillimetrePerSecondSquared
            | Self::StandardGravity
            | Self::MilliGravity => sensor_kind == SensorKind::Accelerometer,
            Self::RadianPerSecond | Self::DegreePerSecond | Self::MilliDegreePerSecond => {
                sensor_kind == SensorKind::Gyroscope
            }
            Self::Counts => true,
            Self::CountsOf(sensitivity) => sensitivity.sensor_kind() == sensor_kind,
        }
    }

    /// As the name of a column ends: `mps2`, `g`, `mg`, `radps`, `degps`, `mdps` or `counts`.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "mps2",
            Self::MillimetrePerSecondSquared => "mmps2",
            Self::RadianPerSecond => "radps",
            Self::DegreePerSecond => "degps",
            Self::StandardGravity
            | Self::MilliGravity
            | Self::MilliDegreePerSecond
            | Self::Counts
            | Self::CountsOf(_) => self.symbol(),
        }
    }

    /// The units that this sensor's readings can have, in words: `m/s², mm/s², g, mg or counts`.
    #[must_use]
    pub fn choices(sensor_kind: SensorKind) -> &'static str {
        match sensor_kind {
            SensorKind::Accelerometer => {
                "m/s², mm/s², g, mg or counts, also of a sensitivity (16384 LSB/g, 0.061 mg/LSB)"
            }
            SensorKind::Gyroscope => {
                "rad/s, deg/s, mdps or counts, also of a sensitivity (131 LSB/dps, 8.75 mdps/LSB)"
            }
        }
    }

    /// Unit after the conversion, and the factor on the readings.
    #[must_use]
    pub fn reading(self) -> (ReadingUnit, f64) {
        match self {
            Self::MetrePerSecondSquared => (ReadingUnit::MetrePerSecondSquared, 1.0),
            Self::MillimetrePerSecondSquared => (ReadingUnit::MetrePerSecondSquared, 1e-3),
            Self::StandardGravity => (ReadingUnit::MetrePerSecondSquared, STANDARD_GRAVITY_MPS2),
            Self::MilliGravity => (ReadingUnit::MetrePerSecondSquared, 1e-3 * STANDARD_GRAVITY_MPS2),
            Self::RadianPerSecond => (ReadingUnit::RadianPerSecond, 1.0),
            Self::DegreePerSecond => (ReadingUnit::RadianPerSecond, std::f64::consts::PI / 180.0),
            Self::MilliDegreePerSecond => (ReadingUnit::RadianPerSecond, std::f64::consts::PI / 180e3),
            Self::Counts => (ReadingUnit::Counts, 1.0),
            Self::CountsOf(of) => (of.sensor_kind().stimulus_unit(), 1.0 / of.counts_per_unit()),
        }
    }
}

/// `16384lsb/g`, `131counts/dps`, `0.061mg/lsb`: lower case, without blanks and brackets.
fn sensitivity(plain: &str) -> Option<Sensitivity> {
    let is_number = |end: &usize| plain.get(..*end).is_some_and(|number| number.parse::<f64>().is_ok());
    let (number, of) = plain.split_at((1..plain.len()).rev().find(is_number)?);
    let is_counts = |text| ImuUnit::parse(text) == Some(ImuUnit::Counts);
    let (number, unit) = match (number.parse::<f64>().ok()?, of.split_once('/'), of.rsplit_once('/')) {
        (number, Some((counts, unit)), _) if is_counts(counts) => (number, unit),
        (number, _, Some((unit, counts))) if is_counts(counts) => (1.0 / number, unit),
        _ => return None,
    };
    // the usual unit of precise accelerometers has no readings of its own: both signs for micro, as letters in lower case
    if let "µg" | "μg" | "ug" = unit {
        return ImuUnit::of_counts(number * 1e3, ImuUnit::MilliGravity)?.sensitivity();
    }
    ImuUnit::of_counts(number, ImuUnit::parse(unit)?)?.sensitivity()
}

impl From<ReadingUnit> for ImuUnit {
    fn from(unit: ReadingUnit) -> Self {
        match unit {
            ReadingUnit::MetrePerSecondSquared => Self::MetrePerSecondSquared,
            ReadingUnit::RadianPerSecond => Self::RadianPerSecond,
            ReadingUnit::Counts => Self::Counts,
        }
    }
}

/// Unit of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnUnit {
    /// Of readings.
    Reading(ImuUnit),
    /// Of times.
    Time(TimeUnit),
    /// Degrees Celsius.
    Celsius,
}

impl ColumnUnit {
    /// As it is printed.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Reading(unit) => unit.symbol(),
            Self::Time(unit) => unit.symbol(),
            Self::Celsius => "°C",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensitivities_are_read_as_datasheets_have_them() {
        let written = |text| Some(ImuUnit::parse(text)?.sensitivity()?.to_string());
        for (text, expected) in [
            ("16384 LSB/g", "16384 LSB/g"),
            ("0.061 mg/LSB", "16393.4 LSB/g"),
            ("3.9 µg/LSB", "256410 LSB/g"),
            ("1670.7 counts/(m/s²)", "16384 LSB/g"),
            ("131 LSB/dps", "131 LSB/dps"),
            ("16.4 LSB/(°/s)", "16.4 LSB/dps"),
            ("8.75 mdps/digit", "114.286 LSB/dps"),
            ("6.1e-2 mg/LSB", "16393.4 LSB/g"),
            ("131 LSB per dps", "131 LSB/dps"),
            ("0.0305 deg/s/LSB", "32.7869 LSB/dps"),
        ] {
            assert_eq!(written(text).as_deref(), Some(expected), "{text}");
        }
        for text in ["16384", "16384 LSB", "0 LSB/g", "LSB/g", "16384 LSB/LSB", "1 g/dps", "1.2.3 LSB/g", "/"]
        {
            assert_eq!(written(text), None, "{text}");
        }
    }
}
