//! Writes `sweep.csv`: the best designs over the values of one variable.

use super::summary::unit_ending;
use calibrant_core::error::Result;
use calibrant_design::{Sweep, SweepPoint};
use calibrant_recording::files::atomic_output::write_atomically;
use std::path::Path;

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
