//! Where each variance comes from, as bars.
//!
//! A table rather than a plot: its letters keep their size on a phone.

use crate::figure::colour;
use crate::html::escape;
use crate::number_format;
use calibrant_machine::estimate::Source;

/// From this share on, a part bears its number.
const NUMBERED: f64 = 0.1;
/// Below this share everywhere, a source is not in the legend.
const SEEN: f64 = 5e-4;

/// Colour of a source, and of letters on it.
fn colours(source: Source) -> (&'static str, &'static str) {
    match source {
        Source::SensorNoise => (colour::BLUE, "#fff"),
        Source::ReferenceNoise => (colour::ORANGE, "#1b1f24"),
        Source::Geometry => (colour::GREEN, "#fff"),
        Source::Mounting => (colour::SKY, "#1b1f24"),
        Source::Timing => (colour::VERMILLION, "#fff"),
        Source::Gravity => (colour::GREY, "#fff"),
    }
}

/// One bar for each name with its sd and the shares of its sources.
pub(crate) fn budget_bars(rows: &[(String, String, [f64; Source::ALL.len()])]) -> String {
    let is_seen = |k: usize| rows.iter().any(|(_, _, shares)| shares[k] >= SEEN);
    let legend: String = Source::ALL
        .iter()
        .enumerate()
        .filter(|(k, _)| is_seen(*k))
        .map(|(_, source)| {
            format!(
                "<li><svg viewBox=\"0 0 34 14\" aria-hidden=\"true\"><rect width=\"34\" height=\"14\" fill=\"{}\"/></svg>{}</li>",
                colours(*source).0,
                source_in_words(*source)
            )
        })
        .collect();
    let bars: String = rows.iter().map(|(name, sd, shares)| bar(name, sd, shares)).collect();
    format!(
        "<figure><h3>Where the variance of each parameter comes from</h3><ul class=\"legend\">{legend}</ul>\
         <table class=\"budget\"><tbody>\n{bars}</tbody></table>\
         <figcaption>Each bar is the variance of one parameter, divided among its sources. The largest part names what to improve: a better reference, \
         a better known mount, or more data against noise.</figcaption></figure>"
    )
}

/// A source, as the legend and the table name it.
pub(crate) fn source_in_words(source: Source) -> String {
    source.name().replace('_', " ")
}

fn bar(name: &str, sd: &str, shares: &[f64; Source::ALL.len()]) -> String {
    let parts: String = Source::ALL
        .iter()
        .zip(shares)
        .filter(|(_, share)| share.is_finite() && **share > 0.0)
        .map(|(source, share)| {
            let (fill, ink) = colours(*source);
            let percent = number_format::percent(*share);
            let text = if *share >= NUMBERED { percent.as_str() } else { "" };
            format!(
                "<span style=\"width:{:.2}%;background:{fill};color:{ink}\" title=\"{}: {percent}\">{text}</span>",
                100.0 * share,
                source_in_words(*source)
            )
        })
        .collect();
    format!(
        "<tr><th scope=\"row\">{}</th><td class=\"n\">± {}</td><td><div class=\"stack\">{parts}</div></td></tr>\n",
        escape(name),
        escape(sd)
    )
}
