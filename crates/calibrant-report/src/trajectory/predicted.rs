//! Predicted standard deviations of trajectories, and where they come from.

use crate::design::times;
use crate::figure::{DisplayUnit, budget_bars, source_in_words};
use crate::number_format::uncertainty;
use crate::sheet::{Cell, Column, Table};
use calibrant_core::sensor::ImuQuantity;
use calibrant_machine::estimate::Source;
use calibrant_machine_design::TrajectoryEvaluation;

/// Standard deviations of the parameters; infinite where they are not determined.
fn sds(of: &TrajectoryEvaluation) -> Vec<f64> {
    match &of.covariance {
        Some(covariance) => covariance.diagonal().iter().map(|variance| variance.sqrt()).collect(),
        None => vec![f64::INFINITY; of.quantities.len()],
    }
}

/// The unit of a parameter whose readings are in SI units.
fn unit(quantity: ImuQuantity) -> &'static str {
    quantity.unit(quantity.sensor_kind().stimulus_unit())
}

/// Per parameter: sd of both trajectories, and their ratio.
pub(super) fn promised_table(
    before: (&str, &TrajectoryEvaluation),
    after: Option<(&str, &TrajectoryEvaluation)>,
) -> Table {
    let mut columns: Vec<Column> = vec!["parameter".into(), "unit".into(), format!("sd {}", before.0).into()];
    if let Some((name, _)) = after {
        columns.extend([format!("sd {name}").into(), "better by".into()]);
    }
    let mut table = Table::new(columns);
    let new = after.map(|(_, after)| sds(after));
    for (i, (quantity, old)) in before.1.quantities.iter().zip(sds(before.1)).enumerate() {
        let new = new.as_ref().map(|sd| sd[i]);
        let unit = unit(*quantity);
        let display = DisplayUnit::suited_to(unit, [old].into_iter().chain(new));
        let mut row = vec![Cell::Name(quantity.name()), display.cell(unit), Cell::sd(old, display.factor)];
        row.extend(
            new.into_iter().flat_map(|new| [Cell::sd(new, display.factor), Cell::Number(times(old / new))]),
        );
        table.row(row);
    }
    table
}

/// Per cent of each variance from each source that has a part worth a number.
pub(super) fn shares(of: &TrajectoryEvaluation) -> Table {
    let is_used = |source: &usize| of.budget.iter().any(|row| row.parts[*source] >= 0.005 * row.variance);
    let used: Vec<usize> = (0..Source::ALL.len()).filter(is_used).collect();
    let names = used.iter().map(|source| source_in_words(Source::ALL[*source]));
    let mut table = Table::new(std::iter::once("variance from, %".to_owned()).chain(names));
    for row in &of.budget {
        let percent = |source: &usize| Cell::fixed(100.0 * row.parts[*source] / row.variance, 0);
        table.row(std::iter::once(Cell::Name(row.quantity.name())).chain(used.iter().map(percent)).collect());
    }
    table
}

/// The same as bars.
pub(super) fn bars(of: &TrajectoryEvaluation) -> String {
    let row = |row: &calibrant_machine::estimate::BudgetRow| {
        let unit = unit(row.quantity);
        let sd = uncertainty(row.variance.sqrt());
        let sd = if unit == "1" { sd } else { format!("{sd} {unit}") };
        (row.quantity.name(), sd, row.parts.map(|part| part / row.variance))
    };
    budget_bars(of.budget.iter().map(row).collect())
}
