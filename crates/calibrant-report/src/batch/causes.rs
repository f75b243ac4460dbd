//! The codes of a batch, each with its sensors: the most frequent first.

use super::sensors::{Batch, BatchSensor};
use crate::number_format::UNKNOWN;
use crate::sheet::{Cell, Column, Table};
use calibrant_core::diagnostic::Severity;
use std::collections::BTreeMap;

/// The most sensors that are named for a code.
const MOST_NAMES: usize = 5;

/// What a code does to a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Effect {
    NoResult,
    Error,
    Warning,
}

/// A code, what it means, and the sensors that have it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Cause {
    pub(crate) effect: Effect,
    pub(crate) code: &'static str,
    meaning: &'static str,
    /// By their places in the batch.
    pub(crate) sensors: Vec<usize>,
}

/// The most frequent first.
pub(crate) fn causes(batch: &Batch) -> Vec<Cause> {
    let mut sensors: BTreeMap<(Effect, &str, &str), Vec<usize>> = BTreeMap::new();
    for (number, sensor) in batch.sensors.iter().enumerate() {
        of_sensor(sensor).for_each(|key| sensors.entry(key).or_default().push(number));
    }
    let cause = |((effect, code, meaning), sensors)| Cause { effect, code, meaning, sensors };
    let mut causes: Vec<Cause> = sensors.into_iter().map(cause).collect();
    causes.sort_by_key(|cause| (std::cmp::Reverse(cause.sensors.len()), cause.effect));
    causes
}

fn of_sensor(sensor: &BatchSensor) -> impl Iterator<Item = (Effect, &'static str, &'static str)> {
    let refusal = sensor.verdict.as_ref().err();
    let refusal = refusal.map(|refusal| (Effect::NoResult, refusal.name(), refusal.meaning()));
    let codes = sensor.codes.iter().filter_map(|code| {
        let effect = match code.severity() {
            Severity::Error => Effect::Error,
            Severity::Warning => Effect::Warning,
            Severity::Allowed | Severity::Note => return None,
        };
        Some((effect, code.name(), code.entry().meaning))
    });
    refusal.into_iter().chain(codes)
}

/// What each code means, and which sensors have it.
pub(super) fn table(batch: &Batch, causes: &[Cause]) -> Table {
    let columns = ["code".into(), Column::new("sensors"), "which".into(), "meaning".into()];
    let mut table = Table::new(columns).on_page();
    for cause in causes {
        let named = cause.sensors.iter().take(MOST_NAMES).map(|&number| batch.sensors[number].name.clone());
        let mut which: Vec<String> = named.collect();
        let further = cause.sensors.len().saturating_sub(MOST_NAMES);
        which.extend((further > 0).then(|| format!("and {further} more")));
        let which = if which.is_empty() { UNKNOWN.to_owned() } else { which.join("\n") };
        table.row(vec![
            Cell::name(cause.code),
            Cell::count(cause.sensors.len()),
            Cell::Text(which),
            Cell::Words(cause.meaning.to_owned()),
        ]);
    }
    table
}
