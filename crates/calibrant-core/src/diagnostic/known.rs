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
    /// The evidence.
    pub evidence: KnownEvidence,
}

/// How the data contradict a given value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KnownEvidence {
    /// The result is off by this many standard deviations of the prior.
    Deviations(f64),
    /// The recording alone gives another value.
    RecordingAlone {
        /// That value.
        value: f64,
        /// Its standard deviation.
        sd: f64,
    },
}

impl fmt::Display for KnownMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, given) = (&self.parameter, self.given);
        match self.evidence {
            KnownEvidence::Deviations(deviations) => write!(
                f,
                "the data contradict {name} in [known]: the estimate is {deviations:.0} standard deviations from {given}"
            ),
            KnownEvidence::RecordingAlone { value, sd } => write!(
                f,
                "the recording contradicts {name} in [known]: the given value is {given:?}, but the recording alone gives {value:.5} ± {sd:.1e}"
            ),
        }
    }
}

impl Part for KnownMismatch {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.parameter.clone());
        parts.numbers.push(("given", self.given));
        match self.evidence {
            KnownEvidence::Deviations(deviations) => parts.numbers.push(("deviations", deviations)),
            KnownEvidence::RecordingAlone { value, sd } => {
                parts.numbers.extend([("found", value), ("found_sd", sd)]);
            }
        }
    }
}
