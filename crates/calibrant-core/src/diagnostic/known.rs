//! A parameter whose given value the data contradict.

use crate::diagnostic::parts::{Part, Parts};
use std::fmt;

/// A parameter whose value in `[known]` the data contradict.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownMismatch {
    /// Its name.
    pub parameter: String,
    /// Its value in `[known]`.
    pub given: f64,
    /// What the recording alone gives.
    pub found: f64,
    /// Its standard deviation.
    pub found_sd: f64,
}

impl fmt::Display for KnownMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { parameter, given, found, found_sd } = self;
        write!(
            f,
            "the recording contradicts {parameter} in [known]: the given value is {given:?}, but the recording alone gives {found:.5} ± {found_sd:.1e}"
        )
    }
}

impl Part for KnownMismatch {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.parameter.clone());
        let numbers = [("given", self.given), ("found", self.found), ("found_sd", self.found_sd)];
        parts.numbers.extend(numbers);
    }
}
