//! Times that a file gives as text: a time of day, or a date with it.

use jiff::civil::Date;
use jiff::tz::Offset;

/// Nanoseconds of a day: a time of day begins anew there.
pub(crate) const DAY_NS: f64 = 86_400e9;

/// Durations are shorter, s.
const LONGEST_S: f64 = 1e9;

/// A time that was given as text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TextTime {
    /// Nanoseconds since 1970, or since midnight.
    pub(crate) ns: i64,
    /// Is the day known? Of `03/05/2024` it is not: the order of day and month is anyone's.
    pub(crate) has_date: bool,
}

impl TextTime {
    /// The time of a text: `2024-03-05T13:35:38.42Z`, `2024/03/05 13:35:38`, `13:35:38.420`, `1:35:38 PM`; the durations `0 days 00:00:12.5` of pandas and
    /// `12.5 sec` of MATLAB. `None` for another text.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if let Some(ns) = duration(text) {
            return Some(Self { ns, has_date: false });
        }
        let (day, time) = match text.rfind(['T', ' ', '_']).filter(|at| text[..*at].len() >= 8) {
            Some(at) if !is_half_of_day(&text[at + 1..]) => (Some(&text[..at]), &text[at + 1..]),
            Some(at) => match text[..at].rfind(['T', ' ', '_']) {
                Some(earlier) => (Some(&text[..earlier]), &text[earlier + 1..]),
                None => (None, text),
            },
            None => (None, text),
        };
        let of_day = time_of_day(time)?;
        match day {
            None => Some(Self { ns: of_day, has_date: false }),
            Some(day) if !day.contains(|c: char| c.is_ascii_digit()) => None,
            Some(day) => {
                let ns = iso_day(day).and_then(|day| day.checked_mul(DAY_NS as i64)?.checked_add(of_day));
                Some(Self { ns: ns.unwrap_or(of_day), has_date: ns.is_some() })
            }
        }
    }
}

/// Nanoseconds of a duration.
fn duration(text: &str) -> Option<i64> {
    if let Some((days, time)) = text.split_once(" days ") {
        return days.parse::<i64>().ok()?.checked_mul(DAY_NS as i64)?.checked_add(time_of_day(time)?);
    }
    let seconds: f64 = text.strip_suffix(" sec")?.trim().parse().ok()?;
    (seconds.abs() < LONGEST_S).then_some((seconds * 1e9).round() as i64)
}

fn is_half_of_day(text: &str) -> bool {
    text.eq_ignore_ascii_case("am") || text.eq_ignore_ascii_case("pm")
}

/// Days since 1970 of a date whose year stands first.
fn iso_day(text: &str) -> Option<i64> {
    let mut parts = text.splitn(3, ['-', '/', '.']);
    let (year, month, day) = (parts.next()?, parts.next()?, parts.next()?);
    let date =
        Date::new(year.parse().ok().filter(|_| year.len() == 4)?, month.parse().ok()?, day.parse().ok()?);
    let midnight = Offset::UTC.to_timestamp(date.ok()?.into()).ok()?;
    Some(midnight.as_second() / 86_400)
}

/// Nanoseconds since midnight UTC, or since midnight where no zone is given.
fn time_of_day(text: &str) -> Option<i64> {
    let text = text.trim().trim_end_matches(['Z', 'z']);
    let (text, later_h) = match text.get(text.len().saturating_sub(2)..) {
        Some(half) if is_half_of_day(half) => {
            (text[..text.len() - 2].trim_end(), if half.eq_ignore_ascii_case("pm") { 12 } else { 0 })
        }
        _ => (text, -1),
    };
    let (text, zone_s) = match text.rfind(['+', '-']) {
        Some(at) => (&text[..at], zone_s(&text[at..])?),
        None => (text, 0),
    };
    let mut parts = text.splitn(3, [':', '.']);
    let two = |part: &str| part.parse::<i64>().ok().filter(|_| matches!(part.len(), 1 | 2));
    let (hour, minute) = (two(parts.next()?)?, two(parts.next()?)?);
    let (second, fraction) = parts.next().map(|rest| rest.split_once(['.', ',']).unwrap_or((rest, "")))?;
    let second = two(second)?;
    if !text.contains(':') && fraction.is_empty() || hour > 24 || minute > 59 || second > 60 {
        return None;
    }
    let hour = if later_h < 0 { hour } else { hour % 12 + later_h };
    if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let nine: String = fraction.chars().chain("000000000".chars()).take(9).collect();
    Some((hour * 3600 + minute * 60 + second - zone_s) * 1_000_000_000 + nine.parse::<i64>().ok()?)
}

/// Seconds of a zone such as `+01:00` or `-0700`.
fn zone_s(text: &str) -> Option<i64> {
    let digits: String = text.chars().filter(char::is_ascii_digit).collect();
    let (hours, minutes) = (digits.get(..2)?.parse::<i64>().ok()?, digits.get(2..).unwrap_or_default());
    let seconds = 3600 * hours + 60 * if minutes.is_empty() { 0 } else { minutes.parse::<i64>().ok()? };
    Some(if text.starts_with('-') { -seconds } else { seconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_read_in_their_usual_forms() {
        let with_date = |ns| Some(TextTime { ns, has_date: true });
        let of_day = |ns| Some(TextTime { ns, has_date: false });
        const T: i64 = 1_709_645_738_420_000_000; // date -u -d '2024-03-05 13:35:38.42' +%s%N
        const D: i64 = ((13 * 60 + 35) * 60 + 38) * 1_000_000_000 + 420_000_000;
        for (text, expected) in [
            ("2024-03-05T13:35:38.420Z", with_date(T)),
            ("2024-03-05 13:35:38.42", with_date(T)),
            ("2024/03/05 13:35:38.420000", with_date(T)),
            ("2024-03-05T14:35:38.42+01:00", with_date(T)),
            ("2024-03-05T06:35:38,42-0700", with_date(T)),
            ("2024-03-05T13.35.38.420", with_date(T)),
            ("13:35:38.42", of_day(D)),
            ("1:35:38.42 PM", of_day(D)),
            ("03/05/2024 13:35:38.42", of_day(D)),
            ("03/05/2024 1:35:38.42 PM", of_day(D)),
            ("13:35:38", of_day(D - 420_000_000)),
            ("0 days 00:00:12.500000", of_day(12_500_000_000)),
            ("1 days 00:00:00", of_day(DAY_NS as i64)),
            ("12.5 sec", of_day(12_500_000_000)),
            ("2024-03-05", None),
            ("12.5.3", None),
            ("1.5", None),
            ("moved at 13:35:38", None),
            ("", None),
        ] {
            assert_eq!(TextTime::parse(text), expected, "{text}");
        }
    }
}
