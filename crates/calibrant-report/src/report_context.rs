//! The context of a report: everything that it states beside the result itself.

use crate::sheet::{Section, Sheet, SheetVerdict};
use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::Verdict;
use calibrant_core::estimate::Validation;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::SensorParameters;

/// The origin of a result, and further knowledge of it.
///
/// All texts are plain text; the report escapes them.
///
/// # Examples
/// ```
/// use calibrant_report::About;
///
/// let about = About {
///     title: "Calibration of sensor 7".into(),
///     facts: vec![("File".into(), "sensor7.csv".into()), ("Rate".into(), "100 Hz".into())],
///     ..About::default()
/// };
/// assert!(about.truth.is_none());
/// ```
#[derive(Debug, Clone, Default)]
pub struct About {
    /// Title of the page.
    pub title: String,
    /// Label and value of what the reader needs to find the input again: file name, sha256, samples, rate,
    /// experiment, options.
    pub facts: Vec<(String, String)>,
    /// Findings about the recording, in words: gaps, repeated times, saturated readings. The page shows them
    /// beside the warnings.
    pub findings: Vec<String>,
    /// Is it of an experiment of the thesis (`vamvaka2021`)? Then the page says which figures of the thesis its own are.
    pub of_thesis: bool,
    /// The verdict; `None`: that of the diagnostics alone.
    pub verdict: Option<Verdict>,
    /// The acceptance limits that were checked.
    pub limits: Vec<CheckedLimit>,
    /// The errors of the calibration on data that it did not use, where there is a validation.
    pub validations: Vec<Validation>,
    /// True parameters, where the recording was simulated.
    pub truth: Option<SensorParameters>,
    /// The motion that really happened, where the recording was simulated.
    pub true_motion: Option<JerkControlledMotion>,
}

/// What most results mean by a reading.
pub(super) const READINGS: &str = "Readings are y = S s + b + ν (true → raw); sd is the standard deviation.";

impl About {
    /// A sheet of these parts, with the inputs, and at its foot the program and what `meaning` says. `title` is that of a context without one.
    pub(super) fn sheet<'a>(
        &self,
        title: &str,
        verdict: SheetVerdict,
        sections: Vec<Section<'a>>,
        meaning: &str,
    ) -> Sheet<'a> {
        // without the run time: equal inputs give equal pages
        let made = format!("calibrant {}.", env!("CARGO_PKG_VERSION"));
        Sheet {
            title: if self.title.is_empty() { title.to_owned() } else { self.title.clone() },
            verdict: Some(verdict),
            sections,
            inputs: self.facts.clone(),
            footer: vec![made, meaning.to_owned()],
            of_thesis: self.of_thesis,
            ..Sheet::default()
        }
    }
}
