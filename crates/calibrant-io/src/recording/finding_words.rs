//! The sentences of the findings of a reader, and numbers as messages show them.

use super::reader_finding::{Finding, Noticed};
use calibrant_core::number_format::{counted, plain};
use calibrant_core::sensor::{SensorKind, Temperatures};
use std::fmt;

/// `line 7: 2 rows equal to the one before dropped (first here)`.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if let Some(sensor_kind) = self.sensor_kind.filter(|_| !self.noticed.names_sensor()) {
            write!(f, "{sensor_kind}: ")?;
        }
        f.write_str(&self.noticed.words(self.sensor_kind))?;
        match self.noticed.occurrences() {
            Some(2..) => f.write_str(" (first here)"),
            _ => Ok(()),
        }
    }
}

impl Noticed {
    /// Does its sentence name the sensor?
    fn names_sensor(&self) -> bool {
        matches!(
            self,
            Self::ReadingsMissing(_)
                | Self::ValuesMissing(_)
                | Self::SampleTimesRepeated(_)
                | Self::AxisConstant { .. }
                | Self::AxesEqual { .. }
                | Self::Saturation { .. }
                | Self::FilesApart { .. }
        )
    }

    /// How often it occurs, where the finding is about several places.
    fn occurrences(&self) -> Option<usize> {
        match self {
            Self::TimesMissing(n)
            | Self::ReadingsMissing(n)
            | Self::ValuesMissing(n)
            | Self::RowsRepeated(n)
            | Self::TimesRepeated(n)
            | Self::SampleTimesRepeated(n) => Some(*n),
            _ => None,
        }
    }

    fn words(&self, sensor_kind: Option<SensorKind>) -> String {
        let named = |words: fn(SensorKind) -> String| sensor_kind.map_or_else(String::new, words);
        let of_the = named(|sensor_kind| format!(" of the {sensor_kind}"));
        let its = named(|sensor_kind| format!("{sensor_kind} "));
        match self {
            Self::ColumnsIgnored(names) => {
                format!("ignored column{} {}", if names.len() == 1 { "" } else { "s" }, list(names, 8))
            }
            Self::OtherSensorIgnored(other, names) => format!(
                "its own columns of the {other}, {}, are left aside: the {other} is that of the other file",
                names.join(", ")
            ),
            Self::UnitUnexpected { stated, expected } => format!(
                "readings are in {} by their header, the experiment says {}",
                stated.symbol(),
                expected.symbol()
            ),
            Self::TimesMissing(n) => format!("{} without a time dropped", counted(*n, "row")),
            Self::ReadingsMissing(n) => format!("{} without a reading{of_the}", counted(*n, "row")),
            Self::ValuesMissing(n) => {
                format!("{}{of_the} with a missing or NaN value dropped", counted(*n, "sample"))
            }
            Self::RowsRepeated(n) => format!("{} equal to the one before dropped", counted(*n, "row")),
            Self::TimesRepeated(n) => {
                format!("{} with the time of the one before but another reading dropped", counted(*n, "row"))
            }
            Self::SampleTimesRepeated(n) => {
                format!("{}{of_the} with the time of the one before dropped", counted(*n, "sample"))
            }
            Self::LineTruncated => "truncated last line dropped".into(),
            Self::FileUnfinished { cut, is_after_data, messages, duration_s } => {
                let lost = match is_after_data {
                    true => "no message is missing, only the index is",
                    false => "what was recorded after them is not in the file",
                };
                format!(
                    "{cut}: {} were read, the last one {} s after the first; {lost}; `mcap recover` makes a whole file of it",
                    counted(*messages, "message"),
                    plain(*duration_s, 6)
                )
            }
            Self::Gap { length_s, after_s, samples } => format!(
                "gap of {} s after t = {} s: about {samples:.0} samples are missing",
                plain(*length_s, 6),
                moment(*after_s)
            ),
            Self::MoreGaps { gaps, longest_s, after_s } => format!(
                "and {}; the longest is {} s after t = {} s",
                counted(*gaps, "more gap"),
                plain(*longest_s, 6),
                moment(*after_s)
            ),
            Self::SamplingIrregular { least_s, most_s, rate_hz, missing } => {
                let missing = match *missing > 0.0 {
                    true => format!("; {:.1} % of the samples are missing", 100.0 * missing),
                    false => String::new(),
                };
                format!(
                    "sampling is irregular: time steps from {} to {} ms, usually {} ms ({} Hz){missing}",
                    plain(least_s * 1e3, 6),
                    plain(most_s * 1e3, 6),
                    plain(1.0 / rate_hz * 1e3, 6),
                    plain(*rate_hz, 6)
                )
            }
            Self::AxisConstant { axis, value, times_s: None } => {
                format!("{its}axis {axis} never changes: {} throughout; is it connected?", plain(*value, 6))
            }
            Self::AxisConstant { axis, value, times_s: Some((from_s, to_s)) } => format!(
                "{its}axis {axis} stays at {} from {} to {} s while the others move: is it connected?",
                plain(*value, 6),
                moment(*from_s),
                moment(*to_s)
            ),
            Self::AxesEqual { one, other, times_s: None } => {
                format!(
                    "{its}axes {one} and {other} are the same in every sample: is one column there twice?"
                )
            }
            Self::AxesEqual { one, other, times_s: Some((from_s, to_s)) } => format!(
                "{its}axes {one} and {other} are the same from {} to {} s: is one wired to the other?",
                moment(*from_s),
                moment(*to_s)
            ),
            Self::Saturation { axis, samples, is_largest, value, unit } => format!(
                "{its}axis {axis} may be saturated: {samples} samples in a row at its {} value {} {}",
                if *is_largest { "largest" } else { "smallest" },
                plain(*value, 6),
                unit.symbol()
            ),
            Self::TimesDerived { is_empty, counter, rate_hz, stated_by } => {
                let empty =
                    if *is_empty { "its sample times are missing" } else { "the file has no sample times" };
                let source = stated_by.map_or_else(|| "as given".into(), |key| format!("its `{key}`"));
                let rate = plain(*rate_hz, 6);
                match counter {
                    Some(name) => format!(
                        "{empty}: they are computed from the counter `{name}` and {rate} Hz ({source}); rate_sd_ppm in [columns] is the uncertainty of this rate, 100 ppm if not given"
                    ),
                    None => format!(
                        "{empty} and no counter: each row is taken as one sample at {rate} Hz ({source}), so lost samples do not show; rate_sd_ppm in [columns] is the uncertainty of this rate, 100 ppm if not given"
                    ),
                }
            }
            Self::PacketTimesReplaced(rate_hz) => format!(
                "its times are those of packets, not of samples: each row is taken as one sample at {} Hz (as given), so lost samples do not show; rate_sd_ppm in [columns] is the uncertainty of this rate, 100 ppm if not given",
                plain(*rate_hz, 6)
            ),
            Self::TimesEven { rate_hz, tick_s } => {
                let steps = tick_s.map_or_else(String::new, |tick_s| {
                    format!("the times are steps of {} ms of a clock: ", plain(tick_s * 1e3, 6))
                });
                format!(
                    "{steps}the samples are taken as even, at {} Hz; --times as-logged, or times = \"as-logged\" in [columns], keeps the logged times",
                    plain(*rate_hz, 6)
                )
            }
            Self::RateUnused => "the rate that was given is not used: the file has sample times".into(),
            Self::ClockWrapped(name, wraps) => {
                format!("`{name}` begins anew {}: counted on", counted(*wraps, "time"))
            }
            Self::TimesFromFirst { column, first, unit } => {
                format!("times are counted from the first sample, where `{column}` is {first} {unit}")
            }
            Self::ClockDoubtful { step_s, unit, rate_hz } => format!(
                "the samples are {} s apart: are the times in {unit}? at {} Hz the name of their column ends in _{}",
                plain(*step_s, 6),
                plain(*rate_hz, 6),
                unit.replace('µ', "u")
            ),
            Self::FilesApart { shorter, shorter_s, longer_s, common_s } => {
                let longer = shorter.other();
                let span =
                    |(start, end): &(f64, f64)| format!("from {} to {} s", moment(*start), moment(*end));
                let shared = match *common_s > 0.0 {
                    true => format!("{} s of both", plain(*common_s, 6)),
                    false => {
                        "no time of both; are they of one recording, and their times of one clock?".into()
                    }
                };
                format!(
                    "{shorter}: it was recorded {}, the {longer} {}: {shared}",
                    span(shorter_s),
                    span(longer_s)
                )
            }
            Self::TemperatureMissing { missing, rows, longest_s } => format!(
                "the temperature is missing in {missing} of {}, for up to {} s: it is interpolated between those that have it, and kept constant before the first and after the last",
                counted(*rows, "row"),
                plain(*longest_s, 6)
            ),
            Self::TemperatureImplausible(value_c) => {
                format!("the temperature is {}: {}", plain(*value_c, 6), Temperatures::question(*value_c))
            }
        }
    }
}

/// Names in back quotes, at most this number of them.
pub(crate) fn list(names: &[String], most: usize) -> String {
    let shown: Vec<String> = names
        .iter()
        .take(most)
        .map(|name| format!("`{}`", name.chars().take(40).collect::<String>()))
        .collect();
    let more = names.len().saturating_sub(most);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    shown.join(", ") + &more
}

/// A time as it stands in the file. It serves where six digits do not distinguish it from its neighbours, as
/// in seconds since 1970.
fn moment(time_s: f64) -> String {
    if time_s.abs() < 1e5 { plain(time_s, 6) } else { time_s.to_string() }
}
