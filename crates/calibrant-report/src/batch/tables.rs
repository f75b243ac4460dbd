//! The tables of sensors: those that are not ok, and all.

use super::sensors::{Batch, BatchSensor};
use crate::number_format::{UNKNOWN, capitalised};
use crate::sheet::{Cell, Column, Shown, Table};
use calibrant_core::diagnostic::acceptance::LimitBroken;
use calibrant_core::diagnostic::{Check, Usability};

/// The most sensors of a page in the table of the worst.
const MOST_ON_PAGE: usize = 100;
/// The most sensors of a terminal.
const MOST_ON_TERMINAL: usize = 20;
/// The most sentences on one sensor.
const MOST_REASONS: usize = 3;

/// How many sensors the table of the worst leaves out.
pub(super) struct Further {
    /// Sensors that are not ok, whether they are left out or not.
    pub(super) not_ok: usize,
    /// Of these, those that a page leaves out.
    pub(super) on_page: usize,
    /// Sensors that a terminal leaves out.
    pub(super) on_terminal: usize,
}

/// The sensors, the worst first, with the reasons. Pages show those that are not ok.
pub(super) fn worst_first(batch: &Batch) -> (Table, Further) {
    let mut sensors: Vec<&BatchSensor> = batch.sensors.iter().collect();
    sensors
        .sort_by_key(|of| of.usability().map_or(0, |usability| Usability::Bad as u8 - usability as u8 + 1));
    let places = places(batch);
    let mut columns: Vec<Column> = vec!["sensor".into(), "verdict".into()];
    columns.extend(places.iter().map(|(heading, _)| Column::on_page(*heading)));
    columns.extend(batch.quality.iter().map(Column::new));
    columns.extend(["decided by".into(), Column::on_page("what was found")]);
    let mut table = Table::new(columns);
    let not_ok = sensors.iter().filter(|of| of.usability() != Some(Usability::Ok)).count();
    for (number, sensor) in sensors.iter().enumerate() {
        let on_page = number < not_ok.min(MOST_ON_PAGE);
        let shown = match (on_page, number < MOST_ON_TERMINAL) {
            (true, true) => Shown::Everywhere,
            (true, false) => Shown::OnPage,
            (false, true) => Shown::OnTerminal,
            (false, false) => continue,
        };
        let mut cells = vec![linked(sensor), verdict(sensor)];
        cells.extend(places.iter().map(|(_, of)| text_or_missing(of(sensor))));
        let quality = |k: usize| sensor.quality.get(k).map_or(Cell::Missing, |of| Cell::Number(of.clone()));
        cells.extend((0..batch.quality.len()).map(quality));
        cells.extend([Cell::Text(codes_and_limits(sensor)), Cell::Words(reasons(sensor))]);
        table.row_shown(shown, cells);
    }
    let further = Further {
        not_ok,
        on_page: not_ok.saturating_sub(MOST_ON_PAGE),
        on_terminal: sensors.len().saturating_sub(MOST_ON_TERMINAL),
    };
    (if not_ok == 0 { table.shown(Shown::OnTerminal) } else { table }, further)
}

/// All sensors in their order.
pub(super) fn all(batch: &Batch) -> Table {
    let places = places(batch);
    let mut columns = vec!["order", "sensor", "verdict"];
    columns.extend(places.iter().map(|(heading, _)| *heading));
    columns.push("decided by");
    let mut table = Table::new(columns);
    for (number, sensor) in batch.sensors.iter().enumerate() {
        let mut cells = vec![Cell::count(number + 1), linked(sensor), verdict(sensor)];
        cells.extend(places.iter().map(|(_, of)| text_or_missing(of(sensor))));
        cells.push(Cell::Text(decided_by(sensor)));
        table.row(cells);
    }
    table
}

/// Reads a text of a sensor.
type Of = fn(&BatchSensor) -> Option<&str>;

/// Station and date, where some sensor has one.
fn places(batch: &Batch) -> Vec<(&'static str, Of)> {
    let all: [(&str, Of); 2] =
        [("station", |of| of.station.as_deref()), ("recorded", |of| of.recorded.as_deref())];
    all.into_iter().filter(|(_, of)| batch.sensors.iter().any(|sensor| of(sensor).is_some())).collect()
}

fn text_or_missing(text: Option<&str>) -> Cell {
    text.map_or(Cell::Missing, Cell::text)
}

fn linked(sensor: &BatchSensor) -> Cell {
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
    shown.join("\n")
}

/// A reason with a capital letter first and a point at its end.
fn sentence(reason: &str) -> String {
    // the name of a file or of a parameter keeps its letters
    let is_name = reason.split([' ', ':']).next().is_some_and(|word| word.contains(['.', '_', '/']));
    let text = if is_name { reason.to_owned() } else { capitalised(reason) };
    if text.ends_with(['.', '?', '!', ')']) { text } else { text + "." }
}

fn or_unknown(text: String) -> String {
    if text.is_empty() { UNKNOWN.to_owned() } else { text }
}
