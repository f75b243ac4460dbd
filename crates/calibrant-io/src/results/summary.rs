//! Writes `summary.csv`: one row for each of several recordings.

use super::exact_number;
use calibrant_core::acceptance::{CheckedLimit, Decision};
use calibrant_core::diagnostic::{Diagnostic, Verdict};
use calibrant_core::error::{Error, Refusal, Result};
use calibrant_core::estimate::{Calibration, CalibrationStatus, FitStatistics};
use calibrant_core::sensor::{ImuQuantity, PER_K, Parameter, ReadingUnit};
use calibrant_recording::files::atomic_output::write_atomically;
use calibrant_recording::spreadsheet_text;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::io;
use std::path::Path;

/// A recording and its result.
#[derive(Debug, Clone)]
pub struct SummaryRow {
    /// The place of its results: the name of the recording's file, with a number where names repeat.
    pub file: String,
    /// The recording, as it was given.
    pub recording: String,
    /// Its calibration, or the reason why there is none.
    pub outcome: std::result::Result<Summary, Failure>,
}

/// Why there is no calibration.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The code of the refusal.
    pub code: Refusal,
    /// Its sentence.
    pub message: String,
}

impl From<&Error> for Failure {
    fn from(error: &Error) -> Self {
        Self { code: error.code(), message: error.to_string() }
    }
}

/// The part of a calibration that is kept in memory until `summary.csv` is written.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Summary {
    pub(crate) verdict: Verdict,
    /// Names of the figures that break a limit.
    pub(crate) limits_failed: Vec<String>,
    pub(crate) status: CalibrationStatus,
    /// Its quality: name, with the unit at its end, and number.
    pub(crate) quality: Vec<(String, String)>,
    pub(crate) parameters: Vec<SummaryParameter>,
}

/// A parameter in a summary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SummaryParameter {
    /// Its name.
    pub name: String,
    /// Unit of its numbers.
    #[serde(deserialize_with = "known_unit")]
    pub unit: KnownUnit,
    /// The estimate.
    #[serde(with = "exact_number")]
    pub value: f64,
    /// Its standard deviation.
    #[serde(with = "exact_number")]
    pub sd: f64,
    /// Nominal value, where the datasheet gives it.
    #[serde(with = "exact_number::optional")]
    pub nominal: Option<f64>,
    /// Datasheet spread, where the datasheet gives it.
    #[serde(with = "exact_number::optional")]
    pub spread: Option<f64>,
}

/// The symbol of a unit that parameters have.
// a name of its own, since the text of the file cannot be borrowed for it
type KnownUnit = &'static str;

fn known_unit<'de, D: Deserializer<'de>>(deserializer: D) -> std::result::Result<&'static str, D::Error> {
    let symbol = String::deserialize(deserializer)?;
    let all = ImuQuantity::all(true, true).into_iter().flat_map(|quantity| {
        [quantity.sensor_kind().stimulus_unit(), ReadingUnit::Counts].map(|reading| quantity.unit(reading))
    });
    let known = all.into_iter().find(|unit| *unit == symbol);
    known.ok_or_else(|| D::Error::custom(format!("`{symbol}` is no unit of a parameter")))
}

impl Summary {
    /// The summary of a calibration: verdict, the largest standard deviation, the number of warnings, of holds and rotations and how many of them were
    /// used, the root mean square of `|f| − g` in the holds and of the rotation errors, χ² with its degrees of
    /// freedom and p-value, and the parameters. A motion has no holds, an accelerometer no rotations. `used_share`: of the samples, on a machine.
    #[must_use]
    pub fn of(calibration: &Calibration, used_share: Option<f64>) -> Self {
        let mut quality = vec![("warnings", calibration.warnings.len().to_string())];
        quality.extend(used_share.map(|share| ("used_share", number(Some(share)))));
        if let Some(holds) = calibration.holds() {
            // holds that only just determine the accelerometer leave no residual
            let magnitude = (holds.degrees_of_freedom > 0).then_some(holds.magnitude_residual_rms_mps2);
            quality.push(("holds", holds.holds.len().to_string()));
            quality.push(("holds_used", holds.used().count().to_string()));
            quality.push(("magnitude_rms_mps2", number(magnitude)));
        }
        if calibration.gyroscope.is_some() {
            let rotations = calibration.rotations();
            let used = calibration.used_rotations().count();
            quality.push(("rotations", rotations.len().to_string()));
            quality.push(("rotations_used", used.to_string()));
            quality.push(("rotation_rms_rad", number((used > 0).then(|| calibration.rotation_rms_rad()))));
        }
        quality.extend(fit_figures(&calibration.fit));
        let estimates = calibration.values.iter().zip(calibration.sd());
        let estimate = |(parameter, (value, sd)): (&Parameter, (&f64, f64))| {
            let Parameter { name, unit, nominal, spread } = parameter.clone();
            SummaryParameter { name, unit, value: *value, sd, nominal, spread }
        };
        let parameters: Vec<_> = calibration.parameters.iter().zip(estimates).map(estimate).collect();
        let quality = worst_sd(&parameters).into_iter().chain(quality);
        Self {
            verdict: Verdict::on(calibration.warnings.iter().map(Diagnostic::code), &[]),
            limits_failed: Vec::new(),
            status: calibration.status,
            quality: quality.map(|(name, text)| (name.to_owned(), text)).collect(),
            parameters,
        }
    }

    /// The summary with this verdict, and with these limits.
    #[must_use]
    pub fn judged(self, verdict: Verdict, limits: &[CheckedLimit]) -> Self {
        let failed = limits.iter().filter(|limit| limit.decision == Decision::Fail);
        let limits_failed = failed.map(|limit| limit.figure.name.clone()).collect();
        Self { verdict, limits_failed, ..self }
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    /// Names of the figures that break a limit.
    #[must_use]
    pub fn limits_failed(&self) -> &[String] {
        &self.limits_failed
    }

    /// The parameters.
    #[must_use]
    pub fn parameters(&self) -> &[SummaryParameter] {
        &self.parameters
    }
}

/// What says how well a calibration fits.
fn fit_figures(fit: &FitStatistics) -> [(&'static str, String); 3] {
    [
        ("chi2", number(Some(fit.chi2))),
        ("degrees_of_freedom", fit.degrees_of_freedom.to_string()),
        ("p_value", number(fit.p_value)),
    ]
}

/// The largest standard deviation of the parameters: whose, its ratio, and to what. That is the datasheet's spread where it is known, otherwise the
/// value of a scale factor.
fn worst_sd(parameters: &[SummaryParameter]) -> [(&'static str, String); 3] {
    let largest = |ratio: &dyn Fn(usize) -> Option<f64>| {
        let ratios = (0..parameters.len()).filter_map(|k| Some((k, ratio(k)?)));
        let finite = ratios.filter(|(_, ratio)| ratio.is_finite());
        finite.max_by(|one, other| one.1.total_cmp(&other.1))
    };
    let over_spread = |k: usize| Some(parameters[k].sd / parameters[k].spread?);
    let over_value = |k: usize| {
        let SummaryParameter { name, value, sd, .. } = &parameters[k];
        name.contains(".scale.").then(|| sd / value.abs())
    };
    let found = match largest(&over_spread) {
        Some(found) => Some((found, "datasheet")),
        None => largest(&over_value).map(|found| (found, "value")),
    };
    let name = found.map_or_else(String::new, |((k, _), _)| parameters[k].name.clone());
    [
        ("worst_sd_parameter", name),
        ("worst_sd_ratio", number(found.map(|((_, ratio), _)| ratio))),
        ("worst_sd_relative_to", found.map_or_else(String::new, |(_, to)| to.to_owned())),
    ]
}

/// Writes `summary.csv`: file, recording, verdict and the codes that decide it, status, error, its code, the limits that are broken, the quality of the
/// calibration ([`Summary`]), then value and standard deviation of each parameter.
///
/// Units are in the header (`accelerometer.bias.x_mps2`, `accelerometer.bias.x_sd_mps2`; nothing for pure numbers). A recording without a calibration has the verdict
/// `none`, the status `error`, the reason, the code of that, and empty fields. Several codes or limits are separated by spaces.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_summary(path: &Path, rows: &[SummaryRow]) -> Result<()> {
    // recordings of one experiment have the same parameters; the first calibration names them
    let named = rows.iter().find_map(|row| row.outcome.as_ref().ok());
    write_atomically(path, |out| {
        let mut out = csv::Writer::from_writer(out);
        let first = ["file", "recording", "verdict", "codes", "status", "error", "code", "limits_failed"];
        let mut header = first.map(String::from).to_vec();
        if let Some(named) = named {
            header.extend(named.quality.iter().map(|(name, _)| name.clone()));
            for SummaryParameter { name, unit, .. } in &named.parameters {
                let ending = unit_ending(unit);
                header.extend([format!("{name}{ending}"), format!("{name}_sd{ending}")]);
            }
        }
        out.write_record(&header).map_err(io::Error::other)?;
        for row in rows {
            let mut fields = vec![spreadsheet_text(&row.file), spreadsheet_text(&row.recording)];
            match (&row.outcome, named) {
                (Ok(summary), Some(named)) => fields.extend(summary.fields(named)),
                (Ok(_), None) => {}
                (Err(failure), _) => {
                    let message = spreadsheet_text(&failure.message);
                    let failed = ["none", "", "error", &message, failure.code.name()];
                    fields.extend(failed.map(String::from));
                }
            }
            fields.resize(header.len(), String::new());
            out.write_record(&fields).map_err(io::Error::other)?;
        }
        out.flush()
    })
}

impl Summary {
    /// Its fields after those of the recording, the parameters in the order of another's.
    fn fields(&self, named: &Self) -> Vec<String> {
        let mut fields = vec![
            self.verdict.usability.name().to_owned(),
            self.verdict.code_names().join(" "),
            self.status.name().to_owned(),
            String::new(),
            String::new(),
            self.limits_failed.join(" "),
        ];
        fields.extend(self.quality.iter().map(|(_, text)| text.clone()));
        for column in &named.parameters {
            let found = self.parameters.iter().find(|estimate| estimate.name == column.name);
            fields.push(number(found.map(|estimate| estimate.value)));
            fields.push(number(found.map(|estimate| estimate.sd)));
        }
        fields
    }
}

fn number(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// Units of parameters, each as it ends a column's name; those of temperature terms without the `/K`.
const ENDINGS: [(&str, &str); 8] = [
    ("1", ""),
    ("m/s²", "_mps2"),
    ("counts", "_counts"),
    ("counts/(m/s²)", "_counts_per_mps2"),
    ("rad/s", "_radps"),
    ("counts/(rad/s)", "_counts_per_radps"),
    ("(rad/s)/(m/s²)", "_radps_per_mps2"),
    ("1/(m/s²)", "_per_mps2"),
];

/// A unit as it ends a column's name.
#[must_use]
pub fn unit_ending(unit: &str) -> String {
    let ending = |unit: &str| ENDINGS.iter().find(|(of, _)| *of == unit).map_or("", |(_, ending)| ending);
    match unit.split_once("/K") {
        None => ending(unit).to_owned(),
        Some((of, power)) => {
            let order = ["", "²", "³", "⁴", "⁵"].iter().position(|of| *of == power).unwrap_or_default();
            format!("{}_{}", ending(of), PER_K[order])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_of_a_parameter_has_an_ending_of_its_own() {
        for quantity in ImuQuantity::all(true, true) {
            for reading in [quantity.sensor_kind().stimulus_unit(), ReadingUnit::Counts] {
                let unit = quantity.unit(reading);
                assert!(unit == "1" || !unit_ending(unit).is_empty(), "{unit} of {}", quantity.name());
            }
        }
        assert_eq!(
            ["m/s²/K", "1/K⁵", "counts/K³"].map(unit_ending),
            ["_mps2_per_k", "_per_k5", "_counts_per_k3"]
        );
    }
}
