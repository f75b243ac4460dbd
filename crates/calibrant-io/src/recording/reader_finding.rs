//! The findings of a reader: what it noticed in a recording that can be used nevertheless.

use calibrant_core::diagnostic::{Code, Severity};
use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind};

/// A finding in a recording: what, where, and of which sensor. Its sentence is its `Display`.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What was noticed.
    pub noticed: Noticed,
    /// Line of its first occurrence, from 1, where it is about a line.
    pub line: Option<usize>,
    /// The sensor that it is about, where the recording has two.
    pub sensor_kind: Option<SensorKind>,
    /// Is it about the gyroscope's file of a pair, not the accelerometer's?
    pub in_second_file: bool,
}

/// What a reader noticed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Noticed {
    /// Columns of these names are not needed.
    ColumnsIgnored(Vec<String>),
    /// A file of one sensor of a pair has columns of the other, too.
    OtherSensorIgnored(SensorKind, Vec<String>),
    /// The header's unit is not the experiment's.
    UnitUnexpected {
        /// The header's.
        stated: ReadingUnit,
        /// The experiment's.
        expected: ReadingUnit,
    },
    /// Number of rows without a time, which were dropped.
    TimesMissing(usize),
    /// Number of rows without a reading of the sensor.
    ReadingsMissing(usize),
    /// Number of samples with an empty or NaN value, which were dropped.
    ValuesMissing(usize),
    /// Number of rows that repeat the one before, which were dropped.
    RowsRepeated(usize),
    /// Number of rows with the time of the one before but another reading, which were dropped.
    TimesRepeated(usize),
    /// Number of samples of the sensor with the time of the one before, which were dropped.
    SampleTimesRepeated(usize),
    /// The last line was cut off and was dropped.
    LineTruncated,
    /// The file ends before its container does: the later part of the recording is missing.
    FileUnfinished {
        /// Where it was cut off, in words.
        cut: String,
        /// Is everything there but the index?
        is_after_data: bool,
        /// Messages that were read.
        messages: usize,
        /// Their duration, s.
        duration_s: f64,
    },
    /// Samples are missing: the time makes a jump.
    Gap {
        /// Its length, s.
        length_s: f64,
        /// Time of the sample before it, s.
        after_s: f64,
        /// About how many samples are missing.
        samples: f64,
    },
    /// There are more gaps than are listed.
    MoreGaps {
        /// How many more.
        gaps: usize,
        /// Length of the longest of all, s.
        longest_s: f64,
        /// Time of the sample before that one, s.
        after_s: f64,
    },
    /// The time steps vary.
    SamplingIrregular {
        /// The shortest, s.
        least_s: f64,
        /// The longest that is no gap, s.
        most_s: f64,
        /// Rate of most samples, Hz.
        rate_hz: f64,
        /// Share of the samples that are missing.
        missing: f64,
    },
    /// An axis does not change, though the others move.
    AxisConstant {
        /// The axis.
        axis: Axis,
        /// Its reading.
        value: f64,
        /// From and to, s, where it is not so throughout.
        times_s: Option<(f64, f64)>,
    },
    /// Two axes have the same reading.
    AxesEqual {
        /// The one.
        one: Axis,
        /// The other.
        other: Axis,
        /// From and to, s, where it is not so throughout.
        times_s: Option<(f64, f64)>,
    },
    /// Readings stay at the extreme value as if clipped there.
    Saturation {
        /// The axis.
        axis: Axis,
        /// Samples in a row.
        samples: usize,
        /// Is it the largest value, not the smallest?
        is_largest: bool,
        /// The value.
        value: f64,
        /// Its unit.
        unit: ReadingUnit,
    },
    /// The times follow from a counter or from the rows.
    TimesDerived {
        /// Does the file have a column of times, without values?
        is_empty: bool,
        /// Name of the counter's column; without one the rows count.
        counter: Option<String>,
        /// The sample rate, Hz.
        rate_hz: f64,
        /// The key in the file that states the rate; `None` where the user gives it.
        stated_by: Option<&'static str>,
    },
    /// The times are those of packets. They follow from the rows and this rate, Hz, that was given.
    PacketTimesReplaced(f64),
    /// The times are steps of a host's clock, or the user says that the samples are even: the times follow from the line through them.
    TimesEven {
        /// The sample rate, Hz.
        rate_hz: f64,
        /// The tick of the clock, s.
        tick_s: Option<f64>,
    },
    /// The rate that was given is not needed.
    RateUnused,
    /// The clock in this column began anew. The number counts how often.
    ClockWrapped(String, usize),
    /// The times count from their first.
    TimesFromFirst {
        /// Column of the times.
        column: String,
        /// The first.
        first: i128,
        /// Unit of it.
        unit: &'static str,
    },
    /// The sample times are most likely not in the stated unit.
    ClockDoubtful {
        /// Their steps, s.
        step_s: f64,
        /// Symbol of the likely unit.
        unit: &'static str,
        /// The rate in that unit, Hz.
        rate_hz: f64,
    },
    /// A sensor of a pair of files was recorded for a part of the other's time only, or for nothing of it.
    FilesApart {
        /// The sensor that was recorded for less time.
        shorter: SensorKind,
        /// Begin and end of its recording, s.
        shorter_s: (f64, f64),
        /// Begin and end of the other's, s.
        longer_s: (f64, f64),
        /// What both cover, s; not above 0 where that is nothing.
        common_s: f64,
    },
    /// The temperature is missing in some rows.
    TemperatureMissing {
        /// How many.
        missing: usize,
        /// Of how many rows.
        rows: usize,
        /// The longest time without one, s.
        longest_s: f64,
    },
    /// A temperature, °C, is none at which a sensor works.
    TemperatureImplausible(f64),
}

/// Longest time without a temperature that needs no warning, s: a sensor warms up within minutes.
const LONG_WITHOUT_TEMPERATURE_S: f64 = 30.0;

impl Finding {
    /// Its code, which never changes.
    #[must_use]
    pub fn code(&self) -> Code {
        self.noticed.code()
    }

    /// Is it more than a note: do results of the recording become doubtful?
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.code().severity() >= Severity::Warning
    }

    /// Do the sample times follow from a nominal rate, not from a clock that was recorded?
    #[must_use]
    pub fn is_nominal_rate(&self) -> bool {
        matches!(self.noticed, Noticed::TimesDerived { .. } | Noticed::PacketTimesReplaced(_))
    }

    /// A finding about the recording as a whole.
    pub(crate) fn new(noticed: Noticed) -> Self {
        Self { noticed, line: None, sensor_kind: None, in_second_file: false }
    }

    /// The same finding, at this line.
    pub(crate) fn at(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// The same finding, about this sensor.
    pub(crate) fn about(self, sensor_kind: Option<SensorKind>) -> Self {
        Self { sensor_kind, ..self }
    }
}

impl Noticed {
    fn code(&self) -> Code {
        match self {
            Self::ColumnsIgnored(_) | Self::OtherSensorIgnored(..) => Code::ColumnsIgnored,
            Self::UnitUnexpected { .. } => Code::UnitUnexpected,
            Self::TimesMissing(_) | Self::ReadingsMissing(_) | Self::ValuesMissing(_) => Code::ValuesMissing,
            Self::RowsRepeated(_) => Code::RowsRepeated,
            Self::TimesRepeated(_) | Self::SampleTimesRepeated(_) => Code::TimesRepeated,
            Self::LineTruncated => Code::LineTruncated,
            Self::FileUnfinished { .. } => Code::FileUnfinished,
            Self::Gap { .. } | Self::MoreGaps { .. } => Code::SamplingGap,
            Self::SamplingIrregular { .. } => Code::SamplingIrregular,
            Self::AxisConstant { .. } => Code::AxisStuck,
            Self::AxesEqual { .. } => Code::AxesEqual,
            Self::Saturation { .. } => Code::ReadingsClipped,
            Self::TimesDerived { .. }
            | Self::PacketTimesReplaced(_)
            | Self::TimesEven { .. }
            | Self::RateUnused
            | Self::ClockWrapped(..)
            | Self::TimesFromFirst { .. } => Code::ClockSource,
            Self::ClockDoubtful { .. } => Code::ClockDoubtful,
            Self::FilesApart { common_s, .. } if *common_s > 0.0 => Code::FileShorter,
            Self::FilesApart { .. } => Code::FilesApart,
            Self::TemperatureMissing { longest_s, .. } if *longest_s <= LONG_WITHOUT_TEMPERATURE_S => {
                Code::TemperatureGaps
            }
            Self::TemperatureMissing { .. } | Self::TemperatureImplausible(_) => Code::TemperatureDoubtful,
        }
    }
}

/// The number of occurrences of something, and the first place.
#[derive(Default)]
pub(crate) struct Tally {
    count: usize,
    first: Option<usize>,
}

impl Tally {
    /// One more, at this line (`None` in a file that has no lines).
    pub(crate) fn add(&mut self, line: Option<usize>) {
        self.count += 1;
        self.first = self.first.or(line);
    }

    /// One finding for all occurrences.
    pub(crate) fn report(
        &self,
        findings: &mut Vec<Finding>,
        sensor_kind: Option<SensorKind>,
        noticed: impl Fn(usize) -> Noticed,
    ) {
        if self.count > 0 {
            findings.push(Finding::new(noticed(self.count)).about(sensor_kind).at(self.first));
        }
    }
}
