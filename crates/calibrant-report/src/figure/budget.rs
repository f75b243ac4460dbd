//! Where each variance comes from, as bars.

use crate::figure::bars::{Bars, Part};
use crate::figure::colour;
use crate::figure::drawing::filled;
use crate::number_format;
use calibrant_core::estimate::VarianceSource;

/// From this share on, a part bears its number.
const NUMBERED: f64 = 0.1;
/// Below this share everywhere, a source is not in the legend.
const SEEN: f64 = 5e-4;

/// Colour of a source, and of letters on it. No calibration has two of one colour.
fn colours(source: VarianceSource) -> (&'static str, &'static str) {
    match source {
        VarianceSource::SensorNoise => (colour::BLUE, "#fff"),
        VarianceSource::ReferenceNoise | VarianceSource::BiasDrift => (colour::ORANGE, "#1b1f24"),
        VarianceSource::Geometry | VarianceSource::OtherRecordings => (colour::GREEN, "#fff"),
        VarianceSource::Mounting | VarianceSource::FaceAlignment => (colour::SKY, "#1b1f24"),
        VarianceSource::Timing => (colour::VERMILLION, "#fff"),
        VarianceSource::Gravity => (colour::GREY, "#fff"),
        VarianceSource::SensorPrior => (colour::PURPLE, "#1b1f24"),
        VarianceSource::Thermometer => (colour::YELLOW, "#1b1f24"),
        VarianceSource::CoarseSteps => (colour::BLACK, "#fff"),
        VarianceSource::EarthRate => (colour::BROWN, "#fff"),
    }
}

/// One bar for each name with its sd and the shares of its sources.
pub(crate) fn budget_bars(rows: Vec<(String, String, [f64; VarianceSource::ALL.len()])>) -> Bars {
    let is_seen = |(k, _): &(usize, VarianceSource)| rows.iter().any(|(_, _, shares)| shares[*k] >= SEEN);
    let sign = |(_, source): (usize, VarianceSource)| (filled(colours(source).0), source_in_words(source));
    let legend = VarianceSource::ALL.into_iter().enumerate().filter(is_seen).map(sign).collect();
    let part = |(source, share): (VarianceSource, f64)| {
        let ((colour, ink), percent) = (colours(source), number_format::percent(share));
        let title = format!("{}: {percent}", source_in_words(source));
        let text = if share >= NUMBERED { percent } else { String::new() };
        (share.is_finite() && share > 0.0).then_some(Part { share, colour, ink, title, text })
    };
    let rows = rows.into_iter().map(|(name, sd, shares)| {
        let parts = VarianceSource::ALL.into_iter().zip(shares).filter_map(part).collect();
        (name, format!("± {sd}"), parts)
    });
    Bars {
        title: "Where the variance of each parameter comes from",
        legend,
        rows: rows.collect(),
        caption: "Each bar is the variance of one parameter, divided among its sources. The largest part names what to improve, such as \
                  a better reference, a mount or a gravity that is known better, or more data against noise.",
    }
}

/// A source, as the legend and the table name it.
pub(crate) fn source_in_words(source: VarianceSource) -> String {
    source.name().replace('_', " ")
}
