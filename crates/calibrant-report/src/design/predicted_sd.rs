//! The table of predicted standard deviations of two motions.

use crate::figure::DisplayUnit;
use crate::number_format;
use crate::sheet::{Cell, Table};
use calibrant_core::information::Criterion;
use calibrant_core::sensor::Parameter;
use calibrant_design::{Design, Evaluation};

/// The text in place of the standard deviation of a parameter that is not determined.
const UNDETERMINED: &str = "undetermined";

/// Per parameter: sd of both motions, their ratio, and the lower bound where there is one.
pub(crate) fn promised_table(
    parameters: &[Parameter],
    before: (&str, &Evaluation),
    after: (&str, &Evaluation),
    bound: Option<&[f64]>,
) -> String {
    let with_spread = parameters.iter().any(|parameter| parameter.spread.is_some());
    let (first, second) = (format!("sd, {}", before.0), format!("sd, {}", after.0));
    let mut columns = vec!["parameter", "unit", first.as_str(), second.as_str(), "improvement"];
    if bound.is_some() {
        columns.extend(["lower bound of the sd", "above the bound"]);
    }
    if with_spread {
        columns.push("datasheet spread");
    }
    let mut table = Table::new(columns);
    for (i, ((parameter, old), new)) in parameters.iter().zip(before.1.sd()).zip(after.1.sd()).enumerate() {
        let unit = DisplayUnit::suited_to(parameter.unit, [old, new]);
        let shown = |sd: f64| {
            Cell::Number(if sd.is_finite() {
                number_format::significant(sd * unit.factor, 4)
            } else {
                UNDETERMINED.into()
            })
        };
        let mut row = vec![
            Cell::Name(parameter.name.clone()),
            Cell::Text(if unit.symbol.is_empty() {
                number_format::UNKNOWN.into()
            } else {
                unit.symbol.into()
            }),
        ];
        row.extend([shown(old), shown(new), Cell::Number(times(old / new))]);
        if let Some(bound) = bound {
            let bound = bound.get(i).copied().unwrap_or(f64::NAN);
            let above = if bound > 0.0 && new.is_finite() {
                above(new / bound - 1.0)
            } else {
                number_format::UNKNOWN.into()
            };
            let bound = if bound > 0.0 {
                number_format::significant(bound * unit.factor, 4)
            } else {
                number_format::UNKNOWN.into()
            };
            row.extend([Cell::Number(bound), Cell::Number(above)]);
        }
        if with_spread {
            let spread = parameter.spread.map(|spread| number_format::short(spread * unit.factor));
            row.push(Cell::Number(spread.unwrap_or_else(|| number_format::UNKNOWN.into())));
        }
        table.row(row);
    }
    table.html()
}

/// A factor of improvement: `65 ×`.
pub(crate) fn times(factor: f64) -> String {
    match factor {
        _ if factor.is_finite() && factor < 9.995 => format!("{} ×", number_format::fixed(factor, 2)),
        _ if factor.is_finite() => format!("{} ×", number_format::significant(factor, 3)),
        _ => number_format::UNKNOWN.to_string(),
    }
}

/// An excess over a bound. Rounding may put it slightly below zero. A loose bound is a matter of factors.
pub(crate) fn above(excess: f64) -> String {
    match excess {
        _ if excess.abs() < 5e-5 => "< 0.01 %".to_string(),
        _ if excess < 10.0 => number_format::percent(excess),
        _ => format!("{} times", number_format::significant(excess, 2)),
    }
}

/// The criterion's value for both motions, and its bound.
pub(crate) fn criterion_table(design: &Design) -> String {
    let nats = matches!(design.criterion, Criterion::D(_));
    let shown = |value: f64| Cell::Number(number_format::significant(value - design.floor, 6));
    let mut table = Table::new(["criterion", "value", "meaning"]);
    let mut row = |name: &str, value: Cell, meaning: String| {
        table.row(vec![Cell::Name(name.to_string()), value, Cell::Words(meaning)]);
    };
    if design.floor > 0.0 {
        let meaning = "No motion changes it, and the values below are above it.".to_string();
        row("share of the tilt", Cell::Number(number_format::significant(design.floor, 4)), meaning);
    }
    row("initial motion", shown(design.initial.value), String::new());
    let better = design.gap(design.initial.value, design.optimal.value);
    let meaning = match better {
        _ if !better.is_finite() => String::new(),
        _ if nats => format!("{} nats below the initial motion.", number_format::significant(better, 3)),
        _ if better < 0.5 => {
            format!("The initial motion's value is {} higher.", number_format::percent(better))
        }
        _ => {
            format!(
                "The initial motion's value is {} times as large.",
                number_format::significant(1.0 + better, 3)
            )
        }
    };
    row("optimal motion", shown(design.optimal.value), meaning);
    if let Some(certificate) = &design.certificate {
        let gap = if nats {
            format!("{} nats", number_format::significant(certificate.gap, 2))
        } else {
            above(certificate.gap)
        };
        row(
            "lower bound",
            shown(certificate.lower_bound),
            format!(
                "No admissible motion is below this bound. The optimal motion is at most {gap} above it."
            ),
        );
    }
    table.html()
}
