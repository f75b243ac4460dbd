//! The figure of errors on data that the calibration did not use, beside the prediction of them.

use super::panel::{Panel, Series};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{ErrorKind, UnusedError, ValidatedErrors, Validation};

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
    let middle = |error: &UnusedError| 0.5 * (error.start_s + error.end_s);
    let panel = |(component, title): (usize, &&str)| {
        let zeros = errors.errors.iter().map(|error| (middle(error), 0.0)).collect();
        let bars = errors.errors.iter().map(|error| 2.0 * factor * error.predicted_sd[component]).collect();
        let points = errors.errors.iter();
        let points = points.map(|of| (of.counts, (middle(of), factor * of.error[component])));
        Panel::new(*title, "time (s)", label.as_str())
            .with(Series::bars("±2 sd predicted", colour::GREY, zeros, bars))
            .with_used(["error", "outlier, not counted"], [3.0, 5.0], points)
    };
    titles.iter().enumerate().map(panel).collect()
}
