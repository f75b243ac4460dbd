//! `summary.csv`: one row for each of several recordings.

use super::output::write_atomically;
use crate::error::Result;
use crate::estimate::Calibration;
use std::io;
use std::path::Path;

/// A recording and what came of it.
#[derive(Debug, Clone)]
pub struct SummaryRow<'a> {
    /// Name of the recording's file.
    pub file: String,
    /// Its calibration, or why there is none.
    pub outcome: std::result::Result<&'a Calibration, String>,
}

/// Writes `summary.csv`: file, status, error, χ², degrees of freedom, p-value, then value and standard deviation of each parameter.
///
/// Units are in the header (`bias.x_mps2`, `bias.x_sd_mps2`; nothing for pure numbers). A recording without a calibration has status
/// `error`, the reason, and empty fields.
///
/// # Errors
/// [`Error::Output`](crate::Error::Output) where it cannot be written.
pub fn write_summary(path: &Path, rows: &[SummaryRow<'_>]) -> Result<()> {
    // recordings of one experiment have the same parameters; the first calibration names them
    let named = rows.iter().find_map(|row| row.outcome.as_ref().ok());
    let columns: Vec<(&str, &str)> = named.map_or_else(Vec::new, |calibration| {
        calibration
            .parameters
            .iter()
            .map(|parameter| (parameter.name.as_str(), ending(parameter.unit)))
            .collect()
    });
    write_atomically(path, |out| {
        let mut out = csv::Writer::from_writer(out);
        let mut header: Vec<String> =
            ["file", "status", "error", "chi2", "degrees_of_freedom", "p_value"].map(String::from).to_vec();
        for (name, ending) in &columns {
            header.extend([format!("{name}{ending}"), format!("{name}_sd{ending}")]);
        }
        out.write_record(&header).map_err(io::Error::other)?;
        for row in rows {
            let mut fields = vec![row.file.clone()];
            match &row.outcome {
                Ok(calibration) => fields.extend(calibration_fields(calibration, &columns)),
                Err(reason) => fields.extend(["error".into(), reason.clone()]),
            }
            fields.resize(header.len(), String::new());
            out.write_record(&fields).map_err(io::Error::other)?;
        }
        out.flush()
    })
}

fn calibration_fields(calibration: &Calibration, columns: &[(&str, &str)]) -> Vec<String> {
    let fit = &calibration.fit;
    let mut fields = vec![
        calibration.status.name().to_owned(),
        String::new(),
        number(Some(fit.chi2)),
        fit.degrees_of_freedom.to_string(),
        number(fit.p_value),
    ];
    let sd = calibration.sd();
    for (name, _) in columns {
        let at = calibration.parameters.iter().position(|parameter| parameter.name == *name);
        fields.push(number(at.and_then(|at| calibration.values.get(at).copied())));
        fields.push(number(at.and_then(|at| sd.get(at).copied())));
    }
    fields
}

fn number(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// A unit as it ends a column's name.
pub(super) fn ending(unit: &str) -> &'static str {
    match unit {
        "m/s²" => "_mps2",
        "counts" => "_counts",
        "counts/(m/s²)" => "_counts_per_mps2",
        _ => "",
    }
}
