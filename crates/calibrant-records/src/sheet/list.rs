//! The calibrations, a line for each.

use super::cells::text_or_missing;
use crate::database::KeptRecord;
use calibrant_report::{Cell, Section, Sheet, Table};

/// Records as a sheet: where each calibration comes from, and its verdict.
#[must_use]
pub fn records_sheet(records: &[KeptRecord]) -> Sheet<'static> {
    let mut table = Table::new([
        "id",
        "sensor",
        "recorded",
        "station",
        "verdict",
        "decided by",
        "recording",
        "experiment",
        "program",
    ]);
    records.iter().for_each(|kept| table.row(row(kept)));
    let mut section = Section::default();
    section.table(table);
    Sheet { title: "Records".into(), sections: vec![section], ..Sheet::default() }
}

fn row(kept: &KeptRecord) -> Vec<Cell> {
    let record = &kept.record;
    vec![
        Cell::Name(kept.id.to_string()),
        Cell::text(&record.sensor),
        text_or_missing(record.recorded),
        text_or_missing(record.station.as_ref()),
        Cell::text(record.verdict.usability.name()),
        Cell::unit(&record.verdict.codes.join(" ")),
        Cell::Text(record.recording()),
        text_or_missing(record.experiment.as_ref().map(|file| &file.file)),
        Cell::text(&record.program),
    ]
}
