//! The findings of a reader: what it noticed in a recording that can be used nevertheless.

use std::fmt;

/// The kind of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FindingKind {
    /// Columns that are not needed were not used.
    IgnoredColumns,
    /// The header's unit is not the experiment's.
    Unit,
    /// Samples with an empty or NaN value were dropped.
    Missing,
    /// Rows that repeat the one before were dropped.
    DuplicateRow,
    /// Rows with the time of the one before but another reading were dropped.
    DuplicateTime,
    /// The last line was cut off and was dropped.
    TruncatedLastLine,
    /// The file ends before its container does: the later part of the recording is missing.
    Unfinished,
    /// Samples are missing: the time makes a jump.
    Gap,
    /// The time steps vary.
    IrregularSampling,
    /// An axis never changes.
    ConstantAxis,
    /// Two axes always have the same reading.
    EqualAxes,
    /// Readings stay at the extreme value as if clipped there.
    Saturation,
    /// The source of the sample times, where it is not simply a column of seconds.
    Clock,
    /// A sensor of a pair of files was recorded for a part of the other's time only.
    ShorterThanOther,
    /// The sensors of a pair of files were never recorded at the same time.
    NoCommonTime,
    /// The sample times are most likely not in the stated unit.
    DoubtfulClock,
    /// The temperature is missing in some rows, seldom for long.
    Temperature,
    /// The temperature is missing for so long, or is so implausible, that the results that follow it are
    /// doubtful.
    DoubtfulTemperature,
}

/// A finding in a recording: what, where, and the reader's action.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The kind of finding.
    pub kind: FindingKind,
    /// Line of its first occurrence, from 1, where it is about a line.
    pub line: Option<usize>,
    /// The finding, in words.
    pub message: String,
    /// Is it about the gyroscope's file of a pair, not the accelerometer's?
    pub in_second_file: bool,
}

impl Finding {
    /// Is it more than a note: do results of the recording become doubtful?
    #[must_use]
    pub fn is_warning(&self) -> bool {
        use FindingKind::{DoubtfulClock, DoubtfulTemperature, NoCommonTime, Unfinished};
        matches!(self.kind, DoubtfulClock | DoubtfulTemperature | NoCommonTime | Unfinished)
    }

    pub(super) fn new(kind: FindingKind, line: Option<usize>, message: String) -> Self {
        Self { kind, line, message, in_second_file: false }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        write!(f, "{}", self.message)
    }
}

/// The number of occurrences of something, and the first place.
#[derive(Default)]
pub(super) struct Tally {
    count: usize,
    first: Option<usize>,
}

impl Tally {
    /// One more, at this line (`None` in a file that has no lines).
    pub(super) fn add(&mut self, line: Option<usize>) {
        self.count += 1;
        self.first = self.first.or(line);
    }

    /// One finding for all occurrences; `say` puts the count into words.
    pub(super) fn report(
        &self,
        kind: FindingKind,
        findings: &mut Vec<Finding>,
        say: impl Fn(usize) -> String,
    ) {
        if self.count > 0 {
            let more = if self.count > 1 { " (first here)" } else { "" };
            findings.push(Finding::new(kind, self.first, format!("{}{more}", say(self.count))));
        }
    }
}

/// `1 sample`, `2 samples`.
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A time as it stands in the file. It serves where six digits do not distinguish it from its neighbours, as
/// in seconds since 1970.
pub(super) fn moment(time_s: f64) -> String {
    if time_s.abs() < 1e5 { short(time_s) } else { time_s.to_string() }
}

/// A number in six significant digits, without trailing zeros.
pub(super) fn short(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}
