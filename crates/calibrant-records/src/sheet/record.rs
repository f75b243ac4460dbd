//! One calibration with its parameters.

use crate::database::KeptRecord;
use calibrant_io::HashedFile;
use calibrant_report::{Cell, Section, Sheet, Table, number_format};

/// A record as a sheet: its verdict, where it comes from, and its parameters.
#[must_use]
pub fn record_sheet(kept: &KeptRecord) -> Sheet<'static> {
    let record = &kept.record;
    let codes = match record.verdict.codes.as_slice() {
        [] => String::new(),
        codes => format!(" ({})", codes.join(", ")),
    };
    let verdict = record.verdict.usability.name();
    let title = format!("calibration {} of sensor {}: {verdict}{codes}", kept.id, record.sensor);
    let mut section = Section::new(&title);
    section.facts(facts(kept));
    section.table(parameters(kept));
    Sheet { title, sections: vec![section], ..Sheet::default() }
}

/// Where it comes from.
fn facts(kept: &KeptRecord) -> Vec<(String, String)> {
    let record = &kept.record;
    let file = |of: &HashedFile| format!("{}, SHA-256 {}", of.file, of.sha256);
    let by = format!("{}, {}, {}; inserted {}", record.program, record.plan, record.status, kept.inserted);
    let mut facts = vec![
        ("recorded", record.recorded.map(|time| time.to_string())),
        ("station", record.station.clone()),
        ("by", Some(by)),
        ("experiment", record.experiment.as_ref().map(file)),
        ("motion", record.motion_file.as_ref().map(file)),
    ];
    facts.extend(record.recordings.iter().map(|of| ("recording", Some(file(of)))));
    facts.into_iter().filter_map(|(label, value)| Some((label.to_owned(), value?))).collect()
}

fn parameters(kept: &KeptRecord) -> Table {
    let imu = &kept.record.imu;
    let mut table = Table::new(["parameter", "value", "unit"]);
    for (k, quantity) in imu.quantities.iter().enumerate() {
        let variance = imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(k, k)]);
        let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
        let (value, sd) = (quantity.value(&imu.parameters), variance.max(0.0).sqrt());
        table.row(vec![
            Cell::Name(quantity.name()),
            Cell::Number(number_format::with_sd_or_exact(value, sd)),
            Cell::unit(quantity.unit(readings)),
        ]);
    }
    table
}
