//! The codes of a batch as bars, the most frequent first (a Pareto chart).

use super::super::colour;
use super::super::drawing::{Part, bars, entry, filled};
use crate::batch::Batch;
use crate::number_format::percent;
use calibrant_core::diagnostic::Severity;
use std::collections::BTreeMap;

/// What a code means for the sensor, and its colour, in the order of the legend.
const KINDS: [(&str, &str); 3] =
    [("no result", colour::GREY), ("error", colour::VERMILLION), ("warning", colour::ORANGE)];

/// A bar for each code: its length is the number of sensors that have it. `None` where there is none.
pub(crate) fn code_bars(batch: &Batch) -> Option<String> {
    let mut counts: BTreeMap<(usize, &'static str), usize> = BTreeMap::new();
    for sensor in &batch.sensors {
        let refusal = sensor.verdict.as_ref().err().map(|refusal| (0, refusal.name()));
        let codes = sensor.codes.iter().filter_map(|code| match code.severity() {
            Severity::Error => Some((1, code.name())),
            Severity::Warning => Some((2, code.name())),
            Severity::Allowed | Severity::Note => None,
        });
        refusal.into_iter().chain(codes).for_each(|kind| *counts.entry(kind).or_default() += 1);
    }
    let mut sorted: Vec<((usize, &str), usize)> = counts.into_iter().collect();
    sorted.sort_by_key(|((kind, _), count)| (std::cmp::Reverse(*count), *kind));
    let most = sorted.first()?.1;
    let is_there = |kind: &usize| sorted.iter().any(|((of, _), _)| of == kind);
    let legend: Vec<String> =
        (0..3).filter(is_there).map(|kind| entry(&filled(KINDS[kind].1), KINDS[kind].0)).collect();
    let bar = |((kind, code), count): &((usize, &str), usize)| {
        let share = percent(*count as f64 / batch.sensors.len() as f64);
        let (share_of_most, (title, colour)) = (*count as f64 / most as f64, KINDS[*kind]);
        let part =
            Part { share: share_of_most, colour, ink: "#fff", title: title.into(), text: String::new() };
        ((*code).to_owned(), format!("{count} ({share})"), vec![part])
    };
    Some(bars(
        "Sensors with each code",
        &legend,
        sorted.iter().map(bar),
        "The number of sensors with this code, and their share of the batch. A sensor may have several codes. <code>calibrant explain CODE</code> says what each means, and what to do.",
    ))
}
