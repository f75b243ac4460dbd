//! The codes of a batch as bars, the most frequent first (a Pareto chart).

use super::super::bars::{Bars, Part};
use super::super::colour;
use super::super::drawing::filled;
use crate::batch::{Batch, Cause, Effect};
use crate::number_format::percent;

/// What a code means for the sensor, and its colour, in the order of the legend.
const KINDS: [(Effect, &str, &str); 3] = [
    (Effect::NoResult, "no result", colour::GREY),
    (Effect::Error, "error", colour::VERMILLION),
    (Effect::Warning, "warning", colour::ORANGE),
];

/// A bar for each code: its length is the number of sensors that have it. `None` where there is none.
pub(crate) fn code_bars(batch: &Batch, causes: &[Cause]) -> Option<Bars> {
    let most = causes.first()?.sensors.len();
    let kinds = KINDS.iter().filter(|kind| causes.iter().any(|of| of.effect == kind.0));
    let legend = kinds.map(|(_, name, colour)| (filled(colour), (*name).to_owned())).collect();
    let bar = |cause: &Cause| {
        let count = cause.sensors.len();
        let (_, title, colour) = KINDS[cause.effect as usize];
        let part = Part {
            share: count as f64 / most as f64,
            colour,
            ink: "#fff",
            title: title.into(),
            text: String::new(),
        };
        let share = percent(count as f64 / batch.sensors.len() as f64);
        (cause.code.to_owned(), format!("{count} ({share})"), vec![part])
    };
    Some(Bars {
        title: "Sensors with each code",
        legend,
        rows: causes.iter().map(bar).collect(),
        caption: "The number of sensors with this code, and their share of the batch. A sensor may have several codes. <code>calibrant explain CODE</code> says what to do.",
    })
}
