//! The table of predicted standard deviations of two motions.

use super::criterion::{above, excess_in_words};
use crate::figure::DisplayUnit;
use crate::number_format::{UNKNOWN, fixed, percent, significant};
use crate::sheet::{Cell, Column, Table};
use calibrant_core::information::Criterion;
use calibrant_core::sensor::Parameter;
use calibrant_design::{Design, Evaluation};

/// Per parameter: sd of both motions, their ratio, and the lower bound where there is one.
pub(crate) fn promised_table(
    parameters: &[Parameter],
    before: (&str, &Evaluation),
    after: Option<(&str, &Evaluation)>,
    bound: Option<&[f64]>,
) -> Table {
    let with_spread = parameters.iter().any(|parameter| parameter.spread.is_some());
    let mut columns: Vec<Column> = vec!["parameter".into(), "unit".into(), format!("sd {}", before.0).into()];
    if let Some((name, _)) = after {
        columns.extend([format!("sd {name}").into(), "better by".into()]);
    }
    if bound.is_some() {
        columns.extend(["sd at least".into(), Column::on_page("above the bound")]);
    }
    if with_spread {
        columns.push(Column::on_page("datasheet spread"));
    }
    let mut table = Table::new(columns);
    let new = after.map(|(_, after)| after.sd());
    for (i, (parameter, old)) in parameters.iter().zip(before.1.sd()).enumerate() {
        let new = new.as_ref().map(|sd| sd[i]);
        let unit = DisplayUnit::suited_to(parameter.unit, [old].into_iter().chain(new));
        let mut row =
            vec![Cell::name(&parameter.name), unit.cell(parameter.unit), Cell::sd(old, unit.factor)];
        row.extend(
            new.into_iter().flat_map(|new| [Cell::sd(new, unit.factor), Cell::Number(times(old / new))]),
        );
        if let Some(bound) = bound {
            row.extend(match bound.get(i) {
                Some(&bound) if bound > 0.0 => {
                    let above = new.filter(|new| new.is_finite()).map(|new| above(new / bound - 1.0));
                    [Cell::sd(bound, unit.factor), above.map_or(Cell::Missing, Cell::Number)]
                }
                _ => [Cell::Missing, Cell::Missing],
            });
        }
        if with_spread {
            let spread = parameter.spread.map(|spread| Cell::short(spread * unit.factor));
            row.push(spread.unwrap_or(Cell::Missing));
        }
        table.row(row);
    }
    table
}

/// A factor of improvement: `65 ×`.
pub(crate) fn times(factor: f64) -> String {
    match factor {
        _ if factor.is_finite() && factor < 9.995 => format!("{} ×", fixed(factor, 2)),
        _ if factor.is_finite() => format!("{} ×", significant(factor, 3)),
        _ => UNKNOWN.to_string(),
    }
}

/// The criterion's value for both motions, and its bound.
pub(crate) fn criterion_table(design: &Design) -> Table {
    let nats = matches!(design.criterion, Criterion::D(_));
    let shown = |value: f64| Cell::Number(significant(value - design.floor, 6));
    let mut table = Table::new(["criterion", "value", "meaning"]);
    let mut row = |name: &str, value: Cell, meaning: String| {
        table.row(vec![Cell::Name(name.to_string()), value, Cell::Words(meaning)]);
    };
    if design.floor > 0.0 {
        let meaning = "No motion changes it, and the values below are above it.".to_string();
        row("share of the tilt", Cell::Number(significant(design.floor, 4)), meaning);
    }
    let (name, before) = design.baseline();
    row(name, shown(before.value), String::new());
    let better = design.gap(before.value, design.optimal.value);
    let meaning = match better {
        _ if !better.is_finite() => String::new(),
        _ if nats => format!("{} nats below that of the {name} motion.", significant(better, 3)),
        _ if better < 0.5 => {
            format!("The value of the {name} motion is {} higher.", percent(better))
        }
        _ => {
            format!("The value of the {name} motion is {} times as large.", significant(1.0 + better, 3))
        }
    };
    row("optimal motion", shown(design.optimal.value), meaning);
    if let Some(certificate) = &design.certificate {
        let gap = excess_in_words(&design.criterion, certificate.gap);
        row(
            "lower bound",
            shown(certificate.lower_bound),
            format!(
                "No admissible motion is below this bound. The optimal motion is at most {gap} above it."
            ),
        );
    }
    table
}
