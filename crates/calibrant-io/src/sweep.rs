//! Writes `sweep.json` and `sweep.csv`: the best designs over the values of one variable.

use super::atomic_output::write_atomically;
use super::design::{CertificateFields, EvaluationFields, SettingFields};
use super::json;
use super::summary::unit_ending;
use calibrant_core::error::Result;
use calibrant_design::{DesignProblem, DesignSettings, Sweep, SweepPoint};
use serde::Serialize;
use std::path::Path;

/// Writes `sweep.json`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_sweep(
    path: &Path,
    sweep: &Sweep,
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
) -> Result<()> {
    json::write_json(path, &SweepFile::of(sweep, problem, settings))
}

/// The text that [`write_sweep`] writes.
#[must_use]
pub fn sweep_json(sweep: &Sweep, problem: &DesignProblem<'_>, settings: &DesignSettings) -> String {
    json::to_json(&SweepFile::of(sweep, problem, settings))
}

/// Writes `sweep.csv`: a row for each value. The units are in the names; `sd` of a pure number has none.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_sweep_csv(path: &Path, sweep: &Sweep) -> Result<()> {
    write_atomically(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        let key = sweep.variable.key().trim_start_matches("limits.");
        let mut header = vec![
            key.to_owned(),
            format!("{key}_asked"),
            "intervals".into(),
            "status".into(),
            "error".into(),
            format!("criterion_{}", sweep.criterion.letter()),
            "initial".into(),
            "lower_bound".into(),
            "gap".into(),
        ];
        for parameter in &sweep.parameters {
            header.push(format!("{}_sd{}", parameter.name, unit_ending(parameter.unit)));
        }
        for parameter in &sweep.parameters {
            header.push(format!("{}_sd_initial{}", parameter.name, unit_ending(parameter.unit)));
        }
        csv.write_record(&header)?;
        for point in &sweep.points {
            csv.write_record(row(point, sweep.parameters.len()))?;
        }
        csv.flush()
    })
}

fn row(point: &SweepPoint, parameters: usize) -> Vec<String> {
    let number = |value: f64| if value.is_finite() { format!("{value:?}") } else { String::new() };
    let mut row = vec![number(point.value), number(point.asked), point.intervals.to_string()];
    match &point.outcome {
        Ok(design) => {
            let bound = design.certificate.as_ref();
            row.extend([design.status.name().to_owned(), String::new()]);
            row.extend([design.optimal.value, design.initial.value].map(number));
            row.push(bound.map_or_else(String::new, |bound| number(bound.lower_bound)));
            row.push(bound.map_or_else(String::new, |bound| number(bound.gap)));
            row.extend(design.optimal.sd().into_iter().map(number));
            row.extend(design.initial.sd().into_iter().map(number));
        }
        Err(why) => {
            row.extend(["error".to_owned(), why.clone()]);
            row.extend(vec![String::new(); 4 + 2 * parameters]);
        }
    }
    row
}

#[derive(Serialize)]
struct SweepFile<'a> {
    schema: u32,
    program: String,
    variable: &'static str,
    unit: &'static str,
    points: Vec<PointFields<'a>>,
    setting: SettingFields,
}

#[derive(Serialize)]
struct PointFields<'a> {
    value: f64,
    asked: f64,
    intervals: usize,
    status: &'static str,
    error: Option<&'a str>,
    optimal: Option<EvaluationFields<'a>>,
    initial: Option<EvaluationFields<'a>>,
    certificate: Option<CertificateFields<'a>>,
}

impl<'a> SweepFile<'a> {
    fn of(sweep: &'a Sweep, problem: &DesignProblem<'_>, settings: &DesignSettings) -> SweepFile<'a> {
        let axes = problem.sensor.axes;
        let point = |point: &'a SweepPoint| {
            let design = point.outcome.as_ref().ok();
            let fields =
                |evaluation| EvaluationFields::of(evaluation, &sweep.criterion, &sweep.parameters, axes);
            PointFields {
                value: point.value,
                asked: point.asked,
                intervals: point.intervals,
                status: design.map_or("error", |design| design.status.name()),
                error: point.outcome.as_ref().err().map(String::as_str),
                optimal: design.map(|design| fields(&design.optimal)),
                initial: design.map(|design| fields(&design.initial)),
                certificate: design
                    .and_then(|design| design.certificate.as_ref())
                    .map(|certificate| CertificateFields::of(certificate, &sweep.parameters)),
            }
        };
        Self {
            schema: 1,
            program: crate::atomic_output::program(),
            variable: sweep.variable.key(),
            unit: sweep.variable.unit(),
            points: sweep.points.iter().map(point).collect(),
            setting: SettingFields::of(problem, settings),
        }
    }
}
