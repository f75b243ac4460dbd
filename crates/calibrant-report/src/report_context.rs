//! The context of a report: everything that it states beside the result itself.

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

impl About {
    /// The program, without its run time: equal inputs give equal pages.
    pub(super) fn made() -> String {
        format!("calibrant {}.", env!("CARGO_PKG_VERSION"))
    }

    pub(super) fn footer() -> Vec<String> {
        vec![
            Self::made(),
            "Readings are y = S s + b + ν (true → raw); sd is the standard deviation.".to_string(),
        ]
    }
}
