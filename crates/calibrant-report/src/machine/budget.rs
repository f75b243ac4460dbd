//! Where variances come from: of a calibration, and of what a trajectory promises.

use crate::figure::{budget_bars, source_in_words};
use crate::number_format::uncertainty;
use crate::sheet::{Cell, Table};
use calibrant_core::sensor::ImuQuantity;
use calibrant_machine::estimate::{BudgetRow, Source};

/// Per cent of the variance from each source that has a part worth a number.
pub(crate) fn shares(budget: &[BudgetRow]) -> Table {
    let is_used = |source: &usize| budget.iter().any(|row| row.parts[*source] >= 0.005 * row.variance);
    let used: Vec<usize> = (0..Source::ALL.len()).filter(is_used).collect();
    let names = used.iter().map(|source| source_in_words(Source::ALL[*source]));
    let mut table = Table::new(std::iter::once("variance from, %".to_owned()).chain(names));
    for row in budget {
        let percent = |source: &usize| Cell::fixed(100.0 * row.parts[*source] / row.variance, 0);
        table.row(std::iter::once(Cell::Name(row.quantity.name())).chain(used.iter().map(percent)).collect());
    }
    table
}

/// The same as bars, with the standard deviation in this unit.
pub(crate) fn bars(budget: &[BudgetRow], unit: impl Fn(ImuQuantity) -> &'static str) -> String {
    let bar = |row: &BudgetRow| {
        let unit = unit(row.quantity);
        let sd = uncertainty(row.variance.sqrt());
        let sd = if unit == "1" { sd } else { format!("{sd} {unit}") };
        (row.quantity.name(), sd, row.parts.map(|part| part / row.variance))
    };
    budget_bars(budget.iter().map(bar).collect())
}
