//! The figure of errors on data that the calibration did not use, beside the prediction of them.

use super::panel::{Mark, Panel, Series, Shape};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{ErrorKind, ValidatedErrors, Validation};

/// Each component of each error over time, with twice its predicted standard deviation about zero.
pub(crate) fn validation_errors(validation: &Validation) -> Figure {
    let panels: Vec<Panel> = validation.kinds.iter().flat_map(panels).collect();
    let columns = if panels.len() > 1 { 3 } else { 1 };
    let caption = "Each marker is an error. Each bar is twice its predicted standard deviation. Good: about nineteen in twenty within their bars, without a trend over \
                   time. If most are well within the bars, the standard deviations are larger than necessary.";
    Figure::new("Errors on unused data", panels, caption).with_columns(columns)
}

fn panels(errors: &ValidatedErrors) -> Vec<Panel> {
    let (titles, label): (&[&str], _) = match errors.kind {
        ErrorKind::Magnitude => (&["magnitude in holds"], "corrected |f| − g"),
        ErrorKind::Rate => {
            (&["rate in holds, x", "rate in holds, y", "rate in holds, z"], "corrected rate (°/s)")
        }
        ErrorKind::Rotation => {
            (&["after rotations, one way across", "after rotations, the other way"], "rotation error (°)")
        }
    };
    let largest = errors.errors.iter().map(|error| error.error.amax().max(2.0 * error.predicted_sd.amax()));
    let (factor, label) = match errors.kind {
        ErrorKind::Magnitude => {
            let unit = DisplayUnit::suited_to("m/s²", largest);
            (unit.factor, unit.label(label))
        }
        ErrorKind::Rate | ErrorKind::Rotation => (1.0_f64.to_degrees(), label.to_string()),
    };
    let middle = |start_s: f64, end_s: f64| 0.5 * (start_s + end_s);
    let panel = |(component, title): (usize, &&str)| {
        let zeros = errors.errors.iter().map(|error| (middle(error.start_s, error.end_s), 0.0)).collect();
        let bars = errors.errors.iter().map(|error| 2.0 * factor * error.predicted_sd[component]).collect();
        let points = |counts: bool| -> Vec<(f64, f64)> {
            let chosen = errors.errors.iter().filter(|error| error.counts == counts);
            chosen
                .map(|error| (middle(error.start_s, error.end_s), factor * error.error[component]))
                .collect()
        };
        let dot = Mark::Dots { shape: Shape::Circle, radius: 3.0 };
        let mut panel = Panel::new(*title, "time (s)", label.as_str())
            .with(Series::new("±2 sd predicted", colour::GREY, Mark::ErrorBars, zeros).with_spread(bars))
            .with(Series::new("error", colour::BLUE, dot, points(true)));
        let outlying = points(false);
        if !outlying.is_empty() {
            let cross = Mark::Dots { shape: Shape::Cross, radius: 5.0 };
            panel = panel.with(Series::new("outlier, not counted", colour::VERMILLION, cross, outlying));
        }
        panel
    };
    titles.iter().enumerate().map(panel).collect()
}
