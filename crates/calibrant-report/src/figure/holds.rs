//! Figures of a static calibration: the recording with its holds, and how well each hold fits.

use super::panel::{Mark, Panel, Series, Shade, Shape};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{HoldCalibration, HoldResult};
use calibrant_core::sensor::Recording;

/// Legend of a hold that was used.
const USED: &str = "hold";
/// Legend of a hold that was not used.
const LEFT_OUT: &str = "hold, not used";

/// The recording of each axis with the holds shaded.
pub(crate) fn recording_overview(holds: &HoldCalibration, recording: &Recording) -> Figure {
    let shades: Vec<Shade> = holds
        .holds
        .iter()
        .map(|result| Shade {
            label: if result.used { USED } else { LEFT_OUT },
            colour: if result.used { colour::GREEN } else { colour::VERMILLION },
            from: result.hold.start_s,
            to: result.hold.end_s,
        })
        .filter(|shade| shade.from.is_finite() && shade.to.is_finite())
        .collect();
    let label = format!("reading ({})", recording.unit().symbol());
    let panels = recording
        .active_axes()
        .iter()
        .map(|&axis| {
            let values = recording.readings().iter().map(|reading| reading[axis.index()]);
            let points = thinned(recording.times_s().iter().copied().zip(values));
            let line = Series::new("reading", colour::BLUE, Mark::Line { width: 0.9, dashes: "" }, points);
            Panel {
                shades: shades.clone(),
                ..Panel::new(format!("axis {axis}"), "time (s)", label.as_str()).with(line)
            }
        })
        .collect();
    let mut caption = "Good: every plateau is shaded, and nothing else. The first and last moments of a plateau may be unshaded."
        .to_string();
    if is_thinned(recording.len()) {
        caption.push_str(" The smallest and the largest reading of each pixel column are drawn.");
    }
    Figure::new("The recording and its holds", panels, caption)
}

/// Corrected magnitude less gravity of each hold, beside its expected scatter.
pub(crate) fn hold_residuals(holds: &HoldCalibration) -> Figure {
    let residuals: Vec<f64> = holds.holds.iter().map(|hold| hold.magnitude_residual_mps2).collect();
    let unit = DisplayUnit::suited_to("m/s²", residuals.iter().copied());
    let expected: Vec<f64> = holds
        .holds
        .iter()
        .map(HoldResult::magnitude_sd_mps2)
        .map(|sd| 2.0 * unit.factor * if sd.is_finite() { sd } else { holds.between_holds_sd_mps2 })
        .collect();
    let numbers = 1..=residuals.len();
    let bars = numbers.clone().map(|number| (number as f64, 0.0)).collect();
    let of = |used: bool| {
        let chosen = numbers.clone().zip(&holds.holds).filter(move |(_, hold)| hold.used == used);
        chosen
            .map(|(number, hold)| (number as f64, hold.magnitude_residual_mps2 * unit.factor))
            .collect::<Vec<_>>()
    };
    let mut panel = Panel::new("", "hold", unit.label("corrected |s| − g"))
        .with(Series::new("±2 sd expected", colour::GREY, Mark::ErrorBars, bars).with_spread(expected))
        .with(Series {
            mark: Mark::Dots { shape: Shape::Circle, radius: 3.4 },
            ..Series::dots("hold", colour::BLUE, Shape::Circle, of(true))
        });
    let left_out = of(false);
    if !left_out.is_empty() {
        let mark = Mark::Dots { shape: Shape::Cross, radius: 5.0 };
        panel = panel.with(Series::new("not used", colour::VERMILLION, mark, left_out));
    }
    let caption = "Gravity residual of each hold. Good: about nineteen in twenty within their \
                   bars, and no trend with the number of the hold (a trend is drift, for example with temperature). Each bar allows for the \
                   hold's own influence on the fit: a hold that no other hold checks has a short bar.";
    Figure::new("Magnitude residual of each hold", vec![panel], caption)
}
