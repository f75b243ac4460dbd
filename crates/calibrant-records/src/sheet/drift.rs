//! The sensors that changed most.

use super::cells::{per_year, text_or_missing};
use crate::aging::SensorDrift;
use calibrant_report::{Cell, Section, Sheet, Table, number_format};

/// The most sensors that the table shows.
const MOST_ROWS: usize = 20;
/// A change of this probability is called significant.
const SIGNIFICANT: f64 = 0.01;

/// The drift of all sensors as a sheet: the most significant first, and how many are significant by chance alone.
#[must_use]
pub fn drift_sheet(drifts: &[SensorDrift]) -> Sheet<'static> {
    let mut section = Section::default();
    if drifts.is_empty() {
        section.paragraph("no sensor has two calibrations to compare");
        return Sheet { title: "Drift".into(), sections: vec![section], ..Sheet::default() };
    }
    let somewhere = drifts.iter().filter(|drift| drift.p_value_at_one_place.is_some()).count();
    let at_one = (somewhere > 0).then_some("p at one place");
    let mut columns = vec!["sensor", "change p", "largest aging", "per year", "unit", "aging p"];
    columns.extend(at_one.into_iter().chain(["calibrations", "recorded"]));
    let mut table = Table::new(columns);
    drifts.iter().take(MOST_ROWS).for_each(|drift| table.row(row(drift, at_one.is_some())));
    section.table(table);
    let further = drifts.len().saturating_sub(MOST_ROWS);
    if further > 0 {
        section.paragraph(format!("and {further} more"));
    }
    section.paragraph(format!(
        "p below {SIGNIFICANT}: last change {}; aging {}",
        significant(drifts.iter().filter_map(|drift| Some(drift.last_change?.p_value))),
        significant(drifts.iter().filter_map(|drift| drift.aging_p_value))
    ));
    if somewhere > 0 {
        section.paragraph(format!(
            "nobody says where {} calibrated: what is not known of a place, such as its gravity, is counted as that of several places and may hide a \
             change. `p at one place` is the least p if it was one: below {SIGNIFICANT} {}. Name the station (`--station` of calibrate and of records add), \
             or state gravity",
            match somewhere {
                1 => "1 sensor was".to_owned(),
                many => format!("{} were", number_format::counted(many, "sensor")),
            },
            significant(drifts.iter().filter_map(|drift| drift.p_value_at_one_place))
        ));
    }
    Sheet { title: "Drift".into(), sections: vec![section], ..Sheet::default() }
}

fn row(drift: &SensorDrift, with_one_place: bool) -> Vec<Cell> {
    let aging = drift.largest_aging.as_ref();
    let [change, unit] = aging.map_or([Cell::Missing, Cell::Missing], per_year);
    let dates = drift.first.zip(drift.last).map(|(first, last)| format!("{first} to {last}"));
    let mut row = vec![
        Cell::name(&drift.sensor),
        drift.last_change.map_or(Cell::Missing, |change| Cell::probability(change.p_value)),
        text_or_missing(aging.map(|of| of.invariant.name())),
        change,
        unit,
        drift.aging_p_value.map_or(Cell::Missing, Cell::probability),
    ];
    let at_one_place = drift.p_value_at_one_place.map_or(Cell::Missing, Cell::probability);
    row.extend(with_one_place.then_some(at_one_place));
    row.extend([Cell::count(drift.calibrations), text_or_missing(dates)]);
    row
}

/// How many are significant, and how many would be by chance.
fn significant(p_values: impl Iterator<Item = f64>) -> String {
    let counted = |(all, below), p: f64| (all + 1, below + usize::from(p < SIGNIFICANT));
    let (all, below) = p_values.fold((0, 0), counted);
    let by_chance = number_format::short(SIGNIFICANT * f64::from(all));
    format!("{below} of {all}, where chance alone gives {by_chance}")
}
