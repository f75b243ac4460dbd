//! Counts the occurrences of something in a recording.

use calibrant_core::diagnostic::{Check, Diagnostic};
use calibrant_core::sensor::SensorKind;

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
    pub(crate) fn report<C: Check>(
        &self,
        findings: &mut Vec<Diagnostic>,
        sensor_kind: Option<SensorKind>,
        found: impl Fn(usize) -> C,
    ) {
        if self.count > 0 {
            findings.push(Diagnostic::from(found(self.count)).about(sensor_kind).at_line(self.first));
        }
    }
}
