//! What changed on a sensor from calibration to calibration, and per year.

use super::cells::{per_year, text_or_missing};
use crate::aging::{QuantityAging, SensorChange, SensorHistory};
use calibrant_core::diagnostic::Check;
use calibrant_core::diagnostic::comparison::PlaceUnknown;
use calibrant_core::estimate::ComparedQuantity;
use calibrant_report::{Cell, Digits, Section, Sheet, Table, number_format};

/// The history of a sensor as a sheet: its calibrations with the change to each, and its aging.
#[must_use]
pub fn history_sheet(history: &SensorHistory) -> Sheet<'static> {
    let title = format!(
        "sensor {}: {}, {} with a date and not bad",
        history.sensor,
        number_format::counted(history.calibrations.len(), "calibration"),
        history.aging_from
    );
    let mut calibrations = Section::new(&title);
    let mut table = Table::new(["id", "recorded", "verdict", "change χ²", "p", "largest change"]);
    for kept in &history.calibrations {
        let change = history.changes.iter().find(|change| change.to == kept.id);
        let mut row = vec![
            Cell::Name(kept.id.to_string()),
            text_or_missing(kept.record.recorded),
            Cell::text(kept.record.verdict.usability.name()),
        ];
        row.extend(change.map_or([Cell::Missing, Cell::Missing, Cell::Missing], changed));
        table.row(row);
    }
    calibrations.table(table);
    let mut notes = history.changes.iter().flat_map(|change| &change.comparison.notes);
    if let Some(note) = notes.rfind(|note| note.code() == PlaceUnknown::CODE) {
        calibrations.paragraph(note.message().to_owned());
    }
    Sheet { title, sections: vec![calibrations, aging(&history.aging)], ..Sheet::default() }
}

/// χ² with its degrees of freedom, probability, and the quantity that changed most.
fn changed(change: &SensorChange) -> [Cell; 3] {
    let overall = change.comparison.overall;
    let in_sd = |quantity: &ComparedQuantity| quantity.in_sd.map_or(0.0, f64::abs);
    let largest =
        change.comparison.quantities.iter().max_by(|one, other| in_sd(one).total_cmp(&in_sd(other)));
    let largest = largest.filter(|largest| in_sd(largest) > 0.0).map(|largest| {
        let in_sd = number_format::signed(largest.in_sd.unwrap_or(0.0), 1);
        format!("{} {in_sd} sd", largest.invariant.name())
    });
    [
        overall.map_or(Cell::Missing, |overall| {
            let chi2 = number_format::significant(overall.chi2, 3);
            Cell::Number(format!("{chi2} ({})", overall.degrees_of_freedom))
        }),
        overall.map_or(Cell::Missing, |overall| Cell::probability(overall.p_value)),
        text_or_missing(largest),
    ]
}

fn aging(quantities: &[QuantityAging]) -> Section<'static> {
    let mut section = Section::new("aging");
    if quantities.is_empty() {
        section.paragraph("no aging: it needs two calibrations of different dates");
    }
    let mut table = Table::new(["quantity", "per year", "in sd", "p", "Birge ratio", "unit"]);
    for of in quantities {
        let aging = &of.aging;
        let [per_year, unit] = per_year(of);
        table.row(vec![
            Cell::Name(of.invariant.name()),
            per_year,
            Cell::Value { value: aging.per_year / aging.sd, digits: Digits::Signed(1) },
            Cell::probability(aging.p_value),
            aging.birge_ratio.map_or(Cell::Missing, |ratio| Cell::fixed(ratio, 2)),
            unit,
        ]);
    }
    section.table(table);
    section
}
