//! Where variances come from: of a calibration, and of what a trajectory promises.

use crate::figure::{Bars, budget_bars, source_in_words};
use crate::number_format::uncertainty;
use crate::sheet::{Cell, Section, Table};
use calibrant_core::estimate::{BudgetRow, Calibration, VarianceSource};
use calibrant_core::sensor::ImuQuantity;

/// A smaller share of a variance is nothing.
const WORTH_A_NUMBER: f64 = 0.005;

/// Per cent of the variance from each source that has a part worth a number.
pub(crate) fn shares(budget: &[BudgetRow]) -> Table {
    let is_used = |source: &VarianceSource| budget.iter().any(|row| row.share(*source) >= WORTH_A_NUMBER);
    let used: Vec<VarianceSource> = VarianceSource::ALL.into_iter().filter(is_used).collect();
    let names = used.iter().map(|source| source_in_words(*source));
    let mut table = Table::new(std::iter::once("variance from, %".to_owned()).chain(names));
    for row in budget {
        let percent = |source: &VarianceSource| Cell::fixed(100.0 * row.share(*source), 0);
        table.row(std::iter::once(Cell::Name(row.quantity.name())).chain(used.iter().map(percent)).collect());
    }
    table
}

/// The same as bars, with the standard deviation in this unit.
pub(crate) fn bars(budget: &[BudgetRow], unit: impl Fn(ImuQuantity) -> &'static str) -> Bars {
    let bar = |row: &BudgetRow| {
        let unit = unit(row.quantity);
        let sd = uncertainty(row.variance.sqrt());
        let sd = if unit == "1" { sd } else { format!("{sd} {unit}") };
        (row.quantity.name(), sd, row.parts.map(|part| part / row.variance))
    };
    budget_bars(budget.iter().map(bar).collect())
}

/// As bars, and in standard deviations.
pub(crate) fn on_page<'a>(section: &mut Section<'a>, calibration: &'a Calibration) {
    section.figure(|| Some(bars(&calibration.budget, |quantity| calibration.unit_of(quantity))));
    let mut within = Section::default();
    within.table(deviations(calibration));
    within.paragraph("Each number is a standard deviation. Their squares add up to that of the sd.");
    section.folded("Table of the budget", within);
}

fn deviations(calibration: &Calibration) -> Table {
    let sources = calibration.variance_sources();
    let mut columns = vec!["parameter".to_string(), "sd".into()];
    columns.extend(sources.iter().map(|source| source_in_words(*source)));
    columns.push("unit".into());
    let mut table = Table::new(columns);
    for row in &calibration.budget {
        let sd = |variance: f64| Cell::significant(variance.max(0.0).sqrt(), 2);
        let mut cells = vec![Cell::Name(row.quantity.name()), sd(row.variance)];
        cells.extend(sources.iter().map(|source| sd(row.part(*source))));
        cells.push(Cell::unit(calibration.unit_of(row.quantity)));
        table.row(cells);
    }
    table
}
