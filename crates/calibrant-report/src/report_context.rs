//! What a report says beside the result itself.

use calibrant_core::estimate::Validation;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::SensorParameters;

/// Where a result comes from, and what else is known of it.
///
/// All texts are plain text; the report escapes them.
///
/// # Examples
/// ```
/// use calibrant::report::About;
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
    /// Label and value of what the reader needs to find the input again: file name, sha256, samples, rate, experiment, options.
    pub facts: Vec<(String, String)>,
    /// What was found in the recording, in words: gaps, repeated times, saturated readings. Shown beside the warnings.
    pub findings: Vec<String>,
    /// How the calibration fares on data that were not used for it, where it was tried.
    pub validations: Vec<Validation>,
    /// True parameters, where the recording was simulated.
    pub truth: Option<SensorParameters>,
    /// The motion that really happened, where the recording was simulated.
    pub true_motion: Option<JerkControlledMotion>,
    /// Program and version, for the footer: `calibrant 0.1.0`.
    pub program: String,
}

impl About {
    /// The program. How long it took is not said: equal inputs give equal pages.
    pub(super) fn made(&self) -> String {
        format!("{}.", if self.program.is_empty() { "calibrant" } else { &self.program })
    }

    pub(super) fn footer(&self) -> Vec<String> {
        vec![
            self.made(),
            "“The report” whose figures are named is V. Vamvaka, Optimal Experimental Design for Calibration, 2021. Readings are \
             y = S s + b + ν (true → raw); sd is the standard deviation."
                .to_string(),
        ]
    }
}
