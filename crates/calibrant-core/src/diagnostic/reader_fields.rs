//! What a reader's checks find: the types of their fields, and their words.

use super::parts::{Part, Parts, neither};
use crate::number_format::{counted, plain};
use crate::sensor::SensorKind;
use std::fmt;

/// A value that a row lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissingValue {
    /// Its time.
    Time,
    /// All readings of the sensor.
    Reading,
    /// A reading of an axis.
    Part,
}

/// A time as a clock counts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ticks(pub i128);

/// A part of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Begin, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
}

/// Whence the times of samples come, where they are not simply those of a column of seconds.
#[derive(Debug, Clone, PartialEq)]
pub enum ClockSourceKind {
    /// From a counter, or from the rows.
    Derived {
        /// Does the file have a column of times, without values?
        is_empty: bool,
        /// Name of the counter's column; without one the rows count.
        counter: Option<String>,
        /// The sample rate, Hz.
        rate_hz: f64,
        /// The key in the file that states the rate; `None` where the user gives it.
        stated_by: Option<&'static str>,
        /// Standard deviation of the rate, ppm.
        sd_ppm: f64,
    },
    /// From the rows and a rate that was given: the times in the file are those of packets.
    Packets {
        /// The rate, Hz.
        rate_hz: f64,
        /// Standard deviation of it, ppm.
        sd_ppm: f64,
    },
    /// From the line through all times, which are steps of a host's clock. Or the user says that the samples are even.
    Even {
        /// The sample rate, Hz.
        rate_hz: f64,
        /// The tick of the clock, s.
        tick_s: Option<f64>,
    },
    /// From the file. The rate that was given is not needed.
    RateUnused,
    /// From this column, whose clock began anew so often.
    Wrapped(String, usize),
}

/// The times of two files of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FileTimes {
    /// The sensor that was recorded for less time.
    pub shorter: SensorKind,
    /// Its recording.
    pub shorter_s: Span,
    /// The other.
    pub longer: SensorKind,
    /// The other's.
    pub longer_s: Span,
    /// What both cover, s; not above 0 where that is nothing.
    pub common_s: f64,
}

/// Why a temperature is doubtful.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TemperatureDoubt {
    /// It is missing for long.
    Missing {
        /// Rows without a temperature.
        missing: usize,
        /// Number of rows.
        rows: usize,
        /// The longest time without one, s.
        longest_s: f64,
    },
    /// No sensor works at this temperature, °C.
    Implausible(f64),
}

impl fmt::Display for ClockSourceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let uncertain = |sd_ppm: f64| {
            let sd = if sd_ppm < 1e4 {
                format!("{} ppm", plain(sd_ppm, 3))
            } else {
                format!("{} %", plain(1e-4 * sd_ppm, 3))
            };
            format!("its uncertainty is {sd} (option `rate_sd_ppm`, or rate_sd_ppm in [columns])")
        };
        match self {
            Self::Derived { is_empty, counter, rate_hz, stated_by, sd_ppm } => {
                let sd = uncertain(*sd_ppm);
                let empty =
                    if *is_empty { "its sample times are missing" } else { "the file has no sample times" };
                let source = stated_by.map_or_else(|| "as given".into(), |key| format!("its `{key}`"));
                let rate = plain(*rate_hz, 6);
                match counter {
                    Some(name) => write!(
                        f,
                        "{empty}: they are computed from the counter `{name}` and {rate} Hz ({source}); {sd}"
                    ),
                    None => write!(
                        f,
                        "{empty} and no counter: each row is taken as one sample at {rate} Hz ({source}), so lost samples \
                         do not show; {sd}"
                    ),
                }
            }
            Self::Packets { rate_hz, sd_ppm } => write!(
                f,
                "its times are those of packets, not of samples: each row is taken as one sample at {} Hz (as given), so \
                 lost samples do not show; {}",
                plain(*rate_hz, 6),
                uncertain(*sd_ppm)
            ),
            Self::Even { rate_hz, tick_s } => {
                if let Some(tick_s) = tick_s {
                    write!(f, "the times are steps of {} ms of a clock: ", plain(tick_s * 1e3, 6))?;
                }
                write!(
                    f,
                    "the samples are taken as even, at {} Hz; option `times` as-logged, or times = \"as-logged\" in [columns], \
                     keeps the logged times",
                    plain(*rate_hz, 6)
                )
            }
            Self::RateUnused => f.write_str("the rate that was given is not used: the file has sample times"),
            Self::Wrapped(name, wraps) => {
                write!(f, "`{name}` begins anew {}: counted on", counted(*wraps, "time"))
            }
        }
    }
}

impl fmt::Display for FileTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shorter_s, longer, longer_s, common_s, .. } = self;
        write!(
            f,
            "it was recorded {shorter_s}, the {longer} {longer_s}: {}",
            match *common_s > 0.0 {
                true => format!("{} s of both", plain(*common_s, 6)),
                false => "no time of both; are they of one recording, and their times of one clock?".into(),
            }
        )
    }
}

/// `from 1.5 to 3 s`.
impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "from {} to {} s", moment(self.start_s), moment(self.end_s))
    }
}

impl Part for Span {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.numbers.extend([("start_s", self.start_s), ("end_s", self.end_s)]);
    }
}

impl Part for FileTimes {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        self.shorter_s.add_to(parts, key);
        parts.numbers.push(("common_s", self.common_s));
    }
}

impl Part for ClockSourceKind {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        match self {
            Self::Derived { rate_hz, .. } | Self::Packets { rate_hz, .. } | Self::Even { rate_hz, .. } => {
                parts.numbers.push(("rate_hz", *rate_hz));
            }
            Self::RateUnused => {}
            Self::Wrapped(name, wraps) => {
                parts.subject.push(name.clone());
                parts.numbers.push(("wraps", *wraps as f64));
            }
        }
    }
}

impl Part for TemperatureDoubt {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        match self {
            Self::Missing { missing, rows, longest_s } => parts.numbers.extend([
                ("missing", *missing as f64),
                ("rows", *rows as f64),
                ("longest_s", *longest_s),
            ]),
            Self::Implausible(value_c) => parts.numbers.push(("temperature_c", *value_c)),
        }
    }
}

neither!(MissingValue);

impl Part for Ticks {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        parts.numbers.push((key, self.0 as f64));
    }
}

/// The end of a sentence about several places.
pub(super) fn first_here(count: usize) -> &'static str {
    if count > 1 { " (first here)" } else { "" }
}

pub(super) fn temperature_missing(missing: usize, rows: usize, longest_s: f64) -> String {
    format!(
        "the temperature is missing in {missing} of {}, for up to {} s: it is interpolated between those that have it, and kept \
         constant before the first and after the last",
        counted(rows, "row"),
        plain(longest_s, 6)
    )
}

/// A time as it stands in the file. It serves where six digits do not distinguish it from its neighbours, as
/// in seconds since 1970.
pub(super) fn moment(time_s: f64) -> String {
    if time_s.abs() < 1e5 { plain(time_s, 6) } else { time_s.to_string() }
}

/// Names in back quotes, at most this number of them.
#[must_use]
pub fn quoted(names: &[String], most: usize) -> String {
    let shown: Vec<String> = names
        .iter()
        .take(most)
        .map(|name| format!("`{}`", name.chars().take(40).collect::<String>()))
        .collect();
    let more = names.len().saturating_sub(most);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    shown.join(", ") + &more
}
