//! A clock of two columns: whole seconds, and the rest of them, as in `sec` and `nanosec`.

use super::time_unit::TimeUnit;

const SECONDS: &[&str] = &["sec", "secs", "seconds", "second"];
const RESTS: [(&[&str], TimeUnit); 2] = [
    (&["nanosec", "nanosecs", "nsec", "nsecs", "nanoseconds", "nanosecond"], TimeUnit::Nanosecond),
    (&["usec", "usecs", "microsec", "microseconds", "microsecond"], TimeUnit::Microsecond),
];

/// The columns of such a clock.
pub(crate) struct SplitClock {
    pub(crate) seconds: usize,
    pub(crate) rest: usize,
    /// Unit of the rest.
    pub(crate) unit: TimeUnit,
}

impl SplitClock {
    /// The two columns, by their names and by the first times of both.
    pub(crate) fn find(names: &[String], times: impl Fn(usize) -> Vec<f64>) -> Option<Self> {
        let lower: Vec<String> = names.iter().map(|name| name.trim().to_lowercase()).collect();
        let parts = |k: usize| lower[k].rsplit_once(['.', '_', '/', ' ']).unwrap_or(("", &lower[k]));
        let rest_of = |seconds: usize| {
            (0..lower.len()).find_map(|rest| {
                let (before, word) = parts(rest);
                let unit = unit_of(word)?;
                (before == parts(seconds).0).then_some(Self { seconds, rest, unit })
            })
        };
        let is_of_seconds = |k: &usize| SECONDS.contains(&parts(*k).1);
        let found = (0..lower.len()).filter(is_of_seconds).find_map(rest_of)?;
        let per_second = found.unit.per_second().unwrap_or(1.0);
        let is_rest = |t: &f64| (0.0..per_second).contains(t);
        let is_whole = |t: &f64| t.fract() == 0.0;
        (times(found.rest).iter().all(is_rest) && times(found.seconds).iter().all(is_whole)).then_some(found)
    }
}

/// The unit of the rest of seconds that a column of this name holds.
fn unit_of(word: &str) -> Option<TimeUnit> {
    RESTS.iter().find(|(names, _)| names.contains(&word)).map(|(_, unit)| *unit)
}
