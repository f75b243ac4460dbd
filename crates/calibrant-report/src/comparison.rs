//! Two calibrations side by side.

use crate::number_format::{count, probability, significant};
use crate::sheet::{Cell, Digits, Section, Sheet, Table};
use calibrant_core::estimate::{ComparedQuantity, Comparison, OverallDifference};
use calibrant_core::sensor::InvariantValue;

/// Below this probability, the uncertainties do not explain a difference.
const SIGNIFICANT: f64 = 0.01;

/// A comparison as a sheet: what A and B are, their quantities, and all parameters together. `names`: what A and B are.
#[must_use]
pub fn comparison_sheet(comparison: &Comparison, names: [String; 2]) -> Sheet<'static> {
    let mut section = Section::default();
    section.facts(["A", "B"].map(str::to_owned).into_iter().zip(names).collect());
    let mut table = Table::new(["quantity", "B − A", "in sd", "p", "unit", "A", "B"]);
    comparison.quantities.iter().for_each(|quantity| table.row(row(quantity)));
    section.table(table);
    section.list(comparison.overall.iter().map(together).collect());
    Sheet { title: "Comparison".into(), sections: vec![section], ..Sheet::default() }
}

/// Do the uncertainties explain the difference of all parameters?
fn together(overall: &OverallDifference) -> String {
    let verdict = if overall.p_value < SIGNIFICANT {
        "they differ by more than their uncertainties explain"
    } else {
        "their uncertainties explain the difference"
    };
    let behind = match overall.degrees_behind {
        behind if behind.is_finite() => {
            format!("; the least known scatter has {} degrees of freedom", significant(behind, 2))
        }
        _ => String::new(),
    };
    format!(
        "all parameters together: {verdict}; χ² {} with {} degrees of freedom, p-value {}{behind}",
        significant(overall.chi2, 5),
        count(overall.degrees_of_freedom),
        probability(overall.p_value)
    )
}

/// A row of the table, angles in degrees.
fn row(quantity: &ComparedQuantity) -> Vec<Cell> {
    let is_angle = quantity.unit_a == "rad";
    let scale = if is_angle { 1f64.to_degrees() } else { 1.0 };
    let value = |value: &InvariantValue| match value.sd {
        Some(sd) => Cell::estimate(scale * value.value, scale * sd),
        None => Cell::significant(scale * value.value, 8),
    };
    let unit = match (is_angle, quantity.unit_a == quantity.unit_b) {
        (true, _) => "°".to_owned(),
        (false, true) => quantity.unit_a.to_owned(),
        (false, false) => format!("{} | {}", quantity.unit_a, quantity.unit_b),
    };
    // a difference by rounding does not count
    let rounding = 1e-12 * quantity.a.value.abs().max(quantity.b.value.abs());
    let equal = quantity.difference.is_some_and(|difference| difference.abs() <= rounding);
    let [difference, in_sd] =
        [quantity.difference, quantity.in_sd].map(|found| found.map(|found| if equal { 0.0 } else { found }));
    let digits = |difference: f64| match quantity.sd {
        Some(sd) if scale * sd >= 1e-5 && difference != 0.0 => Digits::RoundedTo(scale * sd),
        Some(_) => Digits::Significant(2),
        None => Digits::Significant(3),
    };
    let in_digits = |of: f64| Cell::Value { value: scale * of, digits: digits(of) };
    let p_value = quantity.p_value.map(|p_value| if equal { 1.0 } else { p_value });
    vec![
        Cell::Name(quantity.invariant.name()),
        difference.map_or(Cell::Missing, in_digits),
        in_sd.map_or(Cell::Missing, |value| Cell::Value { value, digits: Digits::Signed(1) }),
        p_value.map_or(Cell::Missing, Cell::probability),
        Cell::Text(unit),
        value(&quantity.a),
        value(&quantity.b),
    ]
}
