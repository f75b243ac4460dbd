//! The tables of sensors: those that are not ok, and all.

use super::sensors::{Batch, BatchSensor};
use crate::number_format::{self, UNKNOWN};
use crate::sheet::{Cell, Table};
use calibrant_core::diagnostic::acceptance::LimitBroken;
use calibrant_core::diagnostic::{Check, Usability};

/// The most sensors in the table of those that are not ok.
const MOST_ROWS: usize = 100;
/// The most sentences on one sensor.
const MOST_REASONS: usize = 2;

/// Sensors that are not ok, the worst first, with the reasons. `None` where all are ok. The second is the number of those that are left out.
pub(super) fn not_ok(batch: &Batch) -> Option<(String, usize)> {
    let mut sensors: Vec<&BatchSensor> =
        batch.sensors.iter().filter(|of| of.usability() != Some(Usability::Ok)).collect();
    if sensors.is_empty() {
        return None;
    }
    sensors
        .sort_by_key(|of| of.usability().map_or(0, |usability| Usability::Bad as u8 - usability as u8 + 1));
    let columns = ["sensor", "verdict", "decided by", "what was found"];
    let mut table = Table::new(columns);
    for sensor in sensors.iter().take(MOST_ROWS) {
        let mut cells = vec![name(sensor), verdict(sensor), Cell::Text(codes_and_limits(sensor))];
        cells.push(Cell::Words(reasons(sensor)));
        table.row(cells);
    }
    Some((table.html(), sensors.len().saturating_sub(MOST_ROWS)))
}

/// All sensors in their order.
pub(super) fn all(batch: &Batch) -> String {
    let mut table = Table::new(["order", "sensor", "verdict", "decided by"]);
    for (number, sensor) in batch.sensors.iter().enumerate() {
        table.row(vec![
            Cell::Number(number_format::count(number + 1)),
            name(sensor),
            verdict(sensor),
            Cell::Text(decided_by(sensor)),
        ]);
    }
    table.html()
}

fn name(sensor: &BatchSensor) -> Cell {
    match &sensor.link {
        Some(address) => Cell::Link { text: sensor.name.clone(), address: address.clone() },
        None => Cell::Name(sensor.name.clone()),
    }
}

fn verdict(sensor: &BatchSensor) -> Cell {
    match sensor.usability() {
        None => Cell::Flag("no result".into()),
        Some(Usability::Bad) => Cell::Flag("bad".into()),
        Some(other) => Cell::Text(other.name().into()),
    }
}

fn decided_by(sensor: &BatchSensor) -> String {
    match &sensor.verdict {
        Ok(verdict) => or_unknown(verdict.code_names().join(", ")),
        Err(refusal) => refusal.name().to_owned(),
    }
}

/// The codes, and after `limit-broken` the figures that break a limit.
fn codes_and_limits(sensor: &BatchSensor) -> String {
    let code = LimitBroken::CODE.name();
    match sensor.limits_failed.as_slice() {
        [] => decided_by(sensor),
        broken => decided_by(sensor).replace(code, &format!("{code} ({})", broken.join(", "))),
    }
}

fn reasons(sensor: &BatchSensor) -> String {
    let further = sensor.reasons.len().saturating_sub(MOST_REASONS);
    let mut shown: Vec<String> = sensor.reasons.iter().take(MOST_REASONS).map(|of| sentence(of)).collect();
    if further > 0 {
        shown.push(format!("And {further} more."));
    }
    shown.join(" ")
}

/// A reason with a capital letter first and a point at its end.
fn sentence(reason: &str) -> String {
    // the name of a file or of a parameter keeps its letters
    let is_name = reason.split([' ', ':']).next().is_some_and(|word| word.contains(['.', '_', '/']));
    let text = if is_name { reason.to_owned() } else { crate::number_format::capitalised(reason) };
    if text.ends_with(['.', '?', '!', ')']) { text } else { text + "." }
}

fn or_unknown(text: String) -> String {
    if text.is_empty() { UNKNOWN.to_owned() } else { text }
}
