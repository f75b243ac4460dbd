//! A point of time in UTC, as files state it: `2026-05-01`, or `2026-05-01T08:30:00Z`.

use calibrant_core::json_name;
use jiff::Timestamp;
use jiff::civil::{Date, Time};
use jiff::tz::Offset;
use serde::{Deserialize, Deserializer};
use std::fmt;

/// A day in UTC, with its time where that is known.
///
/// # Examples
/// ```
/// use calibrant_recording::UtcTime;
/// let time = UtcTime::from_seconds(1_777_624_200);
/// assert_eq!(time.to_string(), "2026-05-01T08:30:00Z");
/// assert_eq!(UtcTime::parse("20260501_083000"), Some(time));
/// assert_eq!(UtcTime::parse("2026-05-01").unwrap().to_string(), "2026-05-01");
/// assert_eq!(UtcTime::parse("2026-02-29"), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UtcTime {
    /// Only the day is known.
    Day(Date),
    /// The second is known.
    Second(Timestamp),
}

impl UtcTime {
    /// The time of this number of seconds since 1970; the nearest one between the years −9999 and 9999.
    #[must_use]
    pub fn from_seconds(seconds: i64) -> Self {
        let nearest = if seconds < 0 { Timestamp::MIN } else { Timestamp::MAX };
        Self::Second(Timestamp::from_second(seconds).unwrap_or(nearest))
    }

    /// The time that the clock shows.
    #[must_use]
    pub fn now() -> Self {
        Self::from_seconds(Timestamp::now().as_second())
    }

    /// Seconds since 1970. A day without a time counts from its beginning.
    #[must_use]
    pub fn seconds(self) -> i64 {
        match self {
            Self::Day(day) => Offset::UTC.to_timestamp(day.into()).map_or(0, Timestamp::as_second),
            Self::Second(time) => time.as_second(),
        }
    }

    /// The time of a text: `2026-05-01` or `20260501`, then nothing, or one of `T`, `_`, `-` and a blank, and a time: `08:30:00`, `08-30-00` or `083000`,
    /// with or without `Z`. `None` for another text, or for a day that does not exist. A leap second is the second before it.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix('Z').unwrap_or(text);
        let length = if text.as_bytes().get(4) == Some(&b'-') { 10 } else { 8 };
        let (day, time) = text.split_at_checked(length)?;
        let day = Date::strptime("%Y%m%d", digits(day, &["0000-00-00", "00000000"])?).ok()?;
        if time.is_empty() {
            return Some(Self::Day(day));
        }
        let time = time.strip_prefix(['T', '_', '-', ' '])?;
        let time = Time::strptime("%H%M%S", digits(time, &["00:00:00", "00-00-00", "000000"])?).ok()?;
        Offset::UTC.to_timestamp(day.to_datetime(time)).ok().map(Self::Second)
    }
}

/// The digits of a text that has one of these forms, in which 0 stands for every digit.
fn digits(text: &str, forms: &[&str]) -> Option<String> {
    let form = text.replace(|sign: char| sign.is_ascii_digit(), "0");
    forms.contains(&form.as_str()).then(|| text.replace(|sign: char| !sign.is_ascii_digit(), ""))
}

impl fmt::Display for UtcTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Day(day) => day.fmt(f),
            Self::Second(time) => time.fmt(f),
        }
    }
}

json_name!(UtcTime: to_string);

impl<'de> Deserialize<'de> for UtcTime {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text).ok_or_else(|| serde::de::Error::custom(format!("{text:?} is no date")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::ToSpan;

    #[test]
    fn every_day_of_eight_centuries_reads_back() {
        let mut date = Date::constant(1559, 4, 24);
        for _ in 0..300_000 {
            let day = UtcTime::Day(date);
            assert_eq!(UtcTime::parse(&day.to_string()), Some(day), "{day}");
            date = date.saturating_add(1.day());
        }
        for (text, seconds) in
            [("1970-01-01", 0), ("2000-02-29", 951_782_400), ("2038-01-19T03:14:07Z", 2_147_483_647)]
        {
            let time = UtcTime::parse(text).expect("a time");
            assert_eq!((time.seconds(), time.to_string()), (seconds, text.to_owned()));
        }
    }

    #[test]
    fn a_leap_second_is_the_second_before_it() {
        assert_eq!(UtcTime::parse("20161231T235960Z"), UtcTime::parse("2016-12-31 23:59:59"));
        assert!(UtcTime::parse("20161231T235960Z").is_some());
    }

    #[test]
    fn what_is_no_time_is_none() {
        for text in [
            "",
            "2026",
            "2026-5-1",
            "2026-13-01",
            "2026-04-31",
            "2025-02-29",
            "2026-05-01T",
            "2026-05-01T24:00:00",
        ]
        .into_iter()
        .chain([
            "2026-05-0108:30:00",
            "2026-0501",
            "2026-05-01T08:30",
            "20260501T08:3000",
            "+026-05-01",
            "ü0260501",
            "2026-05-01ü",
        ]) {
            assert_eq!(UtcTime::parse(text), None, "{text}");
        }
    }
}
