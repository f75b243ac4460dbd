//! What the sheet of a batch shows: the sensors in the order of their recordings.

use calibrant_core::diagnostic::{Code, Usability, Verdict};
use calibrant_core::error::Refusal;

/// Sensors of one type, each with its result.
///
/// # Examples
/// ```
/// use calibrant_report::{About, Batch, batch_sheet};
/// let (batch, about) = (Batch::default(), About::default());
/// assert!(batch_sheet(&batch, &about).html().contains("no sensor"));
/// ```
#[derive(Debug, Clone, Default)]
pub struct Batch {
    /// The parameters that are compared.
    pub parameters: Vec<BatchParameter>,
    /// The columns that say how good a calibration is, between its verdict and what decides it.
    pub quality: Vec<String>,
    /// The sensors, in the order of their recordings.
    pub sensors: Vec<BatchSensor>,
}

/// A parameter of all sensors.
#[derive(Debug, Clone)]
pub struct BatchParameter {
    /// Name, as in `summary.csv`.
    pub name: String,
    /// Unit of its values.
    pub unit: &'static str,
    /// Nominal value, where the datasheet gives it.
    pub nominal: Option<f64>,
    /// Datasheet spread, one standard deviation, where the datasheet gives it.
    pub spread: Option<f64>,
    /// The least and the largest accepted value, where there is a limit.
    pub accepted: Option<(f64, f64)>,
}

/// A sensor of the batch.
#[derive(Debug, Clone)]
pub struct BatchSensor {
    /// Name, as in `summary.csv`.
    pub name: String,
    /// Address of its own page or file, relative to this page; not yet escaped.
    pub link: Option<String>,
    /// Where it was recorded.
    pub station: Option<String>,
    /// When it was recorded, UTC.
    pub recorded: Option<String>,
    /// The verdict; or why there is no result.
    pub verdict: Result<Verdict, Refusal>,
    /// Its cells in the columns of quality. Empty without a result.
    pub quality: Vec<String>,
    /// Its warnings and errors, each code once. Those that are allowed are left out.
    pub codes: Vec<Code>,
    /// The limits that it breaks.
    pub limits_failed: Vec<String>,
    /// Why it is not ok, in sentences.
    pub reasons: Vec<String>,
    /// Value and standard deviation of each parameter of the batch; NaN where it has none. Empty without a result.
    pub estimates: Vec<(f64, f64)>,
}

impl BatchSensor {
    /// May its result be used? `None`: there is no result.
    pub(crate) fn usability(&self) -> Option<Usability> {
        self.verdict.as_ref().ok().map(|verdict| verdict.usability)
    }

    /// Value and standard deviation of a parameter, where it is known.
    pub(crate) fn estimate(&self, parameter: usize) -> Option<(f64, f64)> {
        self.estimates.get(parameter).copied().filter(|(value, _)| value.is_finite())
    }
}
