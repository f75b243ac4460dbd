//! The codes of a batch as bars, the most frequent first (a Pareto chart).
//!
//! A table rather than a plot: its letters keep their size on a phone.

use super::super::colour;
use crate::batch::Batch;
use crate::html::escape;
use crate::number_format::percent;
use calibrant_core::diagnostic::Severity;
use std::collections::BTreeMap;

/// What a code means for the sensor, in the order of the legend.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Refusal,
    Error,
    Warning,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Refusal, Self::Error, Self::Warning];

    /// Its name, and its colour.
    fn look(self) -> (&'static str, &'static str) {
        match self {
            Self::Refusal => ("no result", colour::GREY),
            Self::Error => ("error", colour::VERMILLION),
            Self::Warning => ("warning", colour::ORANGE),
        }
    }
}

/// A bar for each code: its length is the number of sensors that have it. `None` where there is none.
pub(crate) fn code_bars(batch: &Batch) -> Option<String> {
    let mut counts: BTreeMap<(Kind, &'static str), usize> = BTreeMap::new();
    for sensor in &batch.sensors {
        if let Err(refusal) = &sensor.verdict {
            *counts.entry((Kind::Refusal, refusal.name())).or_default() += 1;
        }
        for code in &sensor.codes {
            let kind = match code.severity() {
                Severity::Error => Kind::Error,
                Severity::Warning => Kind::Warning,
                Severity::Allowed | Severity::Note => continue,
            };
            *counts.entry((kind, code.name())).or_default() += 1;
        }
    }
    let mut sorted: Vec<(Kind, &str, usize)> =
        counts.into_iter().map(|((kind, code), count)| (kind, code, count)).collect();
    sorted.sort_by_key(|(kind, _, count)| (std::cmp::Reverse(*count), *kind));
    let most = sorted.first()?.2;
    let legend: String = Kind::ALL
        .into_iter()
        .filter(|kind| sorted.iter().any(|(of, ..)| of == kind))
        .map(|kind| {
            let (name, fill) = kind.look();
            format!(
                "<li><svg viewBox=\"0 0 34 14\" aria-hidden=\"true\"><rect width=\"34\" height=\"14\" fill=\"{fill}\"/></svg>{name}</li>"
            )
        })
        .collect();
    let bars: String = sorted
        .iter()
        .map(|(kind, code, count)| {
            let share = percent(*count as f64 / batch.sensors.len() as f64);
            format!(
                "<tr><th scope=\"row\">{}</th><td class=\"n\">{count} ({share})</td><td><div class=\"stack\"><span style=\"width:{:.2}%;background:{}\"></span></div></td></tr>\n",
                escape(code),
                100.0 * *count as f64 / most as f64,
                kind.look().1
            )
        })
        .collect();
    Some(format!(
        "<figure><h3>Sensors with each code</h3><ul class=\"legend\">{legend}</ul><table class=\"budget\"><tbody>\n{bars}</tbody></table>\
         <figcaption>The number of sensors with this code, and their share of the batch. A sensor may have several codes. <code>calibrant explain CODE</code> says what each means, and what to do.</figcaption></figure>"
    ))
}
