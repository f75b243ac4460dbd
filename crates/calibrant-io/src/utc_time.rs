//! A point of time in UTC, as files state it: `2026-05-01`, or `2026-05-01T08:30:00Z`.

use serde::{Serialize, Serializer};
use std::fmt;

/// Seconds of a day.
const DAY_S: i64 = 86_400;

/// A day in UTC, with its time where that is known.
///
/// # Examples
/// ```
/// use calibrant_io::UtcTime;
/// let time = UtcTime::from_seconds(1_777_624_200);
/// assert_eq!(time.to_string(), "2026-05-01T08:30:00Z");
/// assert_eq!(UtcTime::parse("20260501_083000"), Some(time));
/// assert_eq!(UtcTime::parse("2026-05-01").unwrap().to_string(), "2026-05-01");
/// assert_eq!(UtcTime::parse("2026-02-29"), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct UtcTime {
    /// Seconds since 1970; those of the day's beginning, where the time is not known.
    seconds: i64,
    /// Is only the day known?
    is_day: bool,
}

impl UtcTime {
    /// The time of this number of seconds since 1970.
    #[must_use]
    pub fn from_seconds(seconds: i64) -> Self {
        Self { seconds, is_day: false }
    }

    /// Seconds since 1970. A day without a time counts from its beginning.
    #[must_use]
    pub fn seconds(self) -> i64 {
        self.seconds
    }

    /// The time of a text: `2026-05-01` or `20260501`, then nothing, or one of `T`, `_`, `-` and a blank, and a time: `08:30:00`, `08-30-00` or `083000`,
    /// with or without `Z`. `None` for another text, or for a day that does not exist.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix('Z').unwrap_or(text);
        let is_split = text.as_bytes().get(4) == Some(&b'-');
        let length = if is_split { 10 } else { 8 };
        let (day, time) = (text.get(..length)?, text.get(length..)?);
        let [year, month, date] = numbers(day, [4, 2, 2], &['-'])?;
        let days = days_of(year, month, date)?;
        if time.is_empty() {
            return Some(Self { seconds: days * DAY_S, is_day: true });
        }
        let time = time.strip_prefix(['T', '_', '-', ' '])?;
        let [hour, minute, second] = numbers(time, [2, 2, 2], &[':', '-'])?;
        // 60: a leap second
        let possible = hour < 24 && minute < 60 && second <= 60;
        possible.then(|| Self::from_seconds(days * DAY_S + 3600 * hour + 60 * minute + second))
    }
}

/// Three numbers of these widths, with one of these signs between them, or with none.
fn numbers(text: &str, widths: [usize; 3], separators: &[char]) -> Option<[i64; 3]> {
    let used = separators.iter().copied().find(|sign| text.contains(*sign));
    let mut rest = text;
    let mut found = [0; 3];
    for (k, width) in widths.into_iter().enumerate() {
        if let (1.., Some(sign)) = (k, used) {
            rest = rest.strip_prefix(sign)?;
        }
        let digits = rest.get(..width).filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()))?;
        (found[k], rest) = (digits.parse().ok()?, &rest[width..]);
    }
    rest.is_empty().then_some(found)
}

/// Days from 1970 to a date of the Gregorian calendar, counted in years that begin in March. `None` for a date that does not exist.
fn days_of(year: i64, month: i64, date: i64) -> Option<i64> {
    let shifted = year - i64::from(month <= 2);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + date - 1;
    let days = 365 * shifted + shifted.div_euclid(4) - shifted.div_euclid(100) + shifted.div_euclid(400);
    let days = days + of_year - 719_468;
    (date_of(days) == (year, month, date)).then_some(days)
}

/// The date of this number of days since 1970.
fn date_of(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468;
    let era = days.div_euclid(146_097);
    let of_era = days.rem_euclid(146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let date = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (year + 400 * era + i64::from(month <= 2), month, date)
}

impl fmt::Display for UtcTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, date) = date_of(self.seconds.div_euclid(DAY_S));
        write!(f, "{year:04}-{month:02}-{date:02}")?;
        if self.is_day {
            return Ok(());
        }
        let of_day = self.seconds.rem_euclid(DAY_S);
        write!(f, "T{:02}:{:02}:{:02}Z", of_day / 3600, of_day / 60 % 60, of_day % 60)
    }
}

impl Serialize for UtcTime {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_day_of_eight_centuries_reads_back() {
        for days in -150_000..150_000 {
            let day = UtcTime { seconds: days * DAY_S, is_day: true };
            assert_eq!(UtcTime::parse(&day.to_string()), Some(day), "{day}");
        }
        for (text, seconds) in
            [("1970-01-01", 0), ("2000-02-29", 951_782_400), ("2038-01-19T03:14:07Z", 2_147_483_647)]
        {
            let time = UtcTime::parse(text).expect("a time");
            assert_eq!((time.seconds(), time.to_string()), (seconds, text.to_owned()));
        }
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
