//! Writes a comparison of two calibrations as JSON.

use super::json;
use calibrant_core::estimate::{ComparedQuantity, Comparison};
use serde::Serialize;

#[derive(Serialize)]
struct File<'a> {
    schema: u32,
    a: &'a str,
    b: &'a str,
    quantities: Vec<Row>,
    overall: Option<Overall>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Row {
    name: String,
    unit: String,
    a: f64,
    a_sd: Option<f64>,
    b: f64,
    b_sd: Option<f64>,
    difference: Option<f64>,
    difference_sd: Option<f64>,
    difference_in_sd: Option<f64>,
    /// `null` where the sd is known.
    degrees_of_freedom: Option<f64>,
    p_value: Option<f64>,
}

#[derive(Serialize)]
struct Overall {
    chi2: f64,
    degrees_of_freedom: usize,
    degrees_behind: Option<f64>,
    p_value: f64,
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// The text of a comparison as JSON. `a` and `b` name the files. Angles are in rad.
#[must_use]
pub fn comparison_json(comparison: &Comparison, a: &str, b: &str) -> String {
    let row = |row: &ComparedQuantity| Row {
        name: row.invariant.name(),
        unit: if row.unit_a == row.unit_b {
            row.unit_a.into()
        } else {
            format!("{} | {}", row.unit_a, row.unit_b)
        },
        a: row.a.value,
        a_sd: row.a.sd,
        b: row.b.value,
        b_sd: row.b.sd,
        difference: row.difference,
        difference_sd: row.sd,
        difference_in_sd: row.in_sd,
        degrees_of_freedom: finite(row.degrees_of_freedom),
        p_value: row.p_value,
    };
    json::to_json(&File {
        schema: 1,
        a,
        b,
        quantities: comparison.quantities.iter().map(row).collect(),
        overall: comparison.overall.map(|overall| Overall {
            chi2: overall.chi2,
            degrees_of_freedom: overall.degrees_of_freedom,
            degrees_behind: finite(overall.degrees_behind),
            p_value: overall.p_value,
        }),
        notes: &comparison.notes,
    })
}
