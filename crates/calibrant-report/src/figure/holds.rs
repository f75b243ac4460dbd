//! Figures of a static calibration: the recording with its holds, and how well each hold fits.

use super::frame::caption;
use super::panel::{Panel, Series, Shade};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{HoldCalibration, HoldResult, RefusedRest};
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{Recording, SensorKind};

/// The recording of each axis with the holds shaded.
pub(crate) fn recording_overview(holds: &HoldCalibration, recording: &Recording) -> Figure {
    let shade = |result: &HoldResult| {
        let (label, colour) =
            if result.used { ("hold", colour::GREEN) } else { ("hold, not used", colour::VERMILLION) };
        Shade { label, colour, from: result.hold.start_s, to: result.hold.end_s }
    };
    let is_finite = |shade: &Shade| shade.from.is_finite() && shade.to.is_finite();
    let shades: Vec<Shade> = holds.holds.iter().map(shade).filter(is_finite).collect();
    timeline("The recording and its holds", shades, recording)
}

/// The readings of each axis, with what is at rest shaded: holds, and what is none.
pub(crate) fn rest_and_motion(
    of: SensorKind,
    holds: &[Hold],
    refused: &[RefusedRest],
    recording: &Recording,
) -> Figure {
    let hold =
        |hold: &Hold| Shade { label: "hold", colour: colour::GREEN, from: hold.start_s, to: hold.end_s };
    let rest = |rest: &RefusedRest| {
        let (label, colour) = match rest.is_short {
            true => ("at rest, too short for a hold", colour::ORANGE),
            false => ("at rest, not steady", colour::VERMILLION),
        };
        Shade { label, colour, from: rest.start_s, to: rest.end_s }
    };
    let shades = holds.iter().map(hold).chain(refused.iter().map(rest)).collect();
    timeline(&format!("The {of} over time"), shades, recording)
}

fn timeline(title: &str, shades: Vec<Shade>, recording: &Recording) -> Figure {
    let label = format!("reading ({})", recording.unit().symbol());
    let panels = Panel::by_axis(recording.active_axes(), "time (s)", &label, |axis, panel| {
        let values = recording.readings().iter().map(|reading| reading[axis.index()]);
        let points = thinned(recording.times_s().iter().copied().zip(values));
        let line = Series::stroke("reading", colour::BLUE, (0.9, ""), points);
        Panel { shades: shades.clone(), ..panel.with(line) }
    });
    let caption = caption(
        "Good: every plateau is shaded, and nothing else. The first and last moments of a plateau may be unshaded.",
        &[(
            is_thinned(recording.len()),
            "The smallest and the largest reading of each pixel column are drawn.",
        )],
    );
    Figure::new(title, panels, caption)
}

/// Corrected magnitude less gravity of each hold, beside its expected scatter.
pub(crate) fn hold_residuals(holds: &HoldCalibration) -> Figure {
    let unit = DisplayUnit::suited_to("m/s²", holds.holds.iter().map(|hold| hold.magnitude_residual_mps2));
    let expected: Vec<f64> = holds
        .holds
        .iter()
        .map(|of| of.magnitude_sd_mps2)
        .map(|sd| 2.0 * unit.factor * if sd.is_finite() { sd } else { holds.between_holds_sd_mps2 })
        .collect();
    let numbered = || (1..).map(f64::from).zip(&holds.holds);
    let residuals =
        numbered().map(|(number, hold)| (hold.used, (number, hold.magnitude_residual_mps2 * unit.factor)));
    let bars = numbered().map(|(number, _)| (number, 0.0)).collect();
    let panel = Panel::new("", "hold", unit.label("corrected |s| − g"))
        .with(Series::bars("±2 sd expected", colour::GREY, bars, expected))
        .with_used(["hold", "not used"], [3.4, 5.0], residuals);
    let caption = "Gravity residual of each hold. Good: about nineteen in twenty within their \
                   bars, and no trend with the number of the hold (a trend is drift, for example with temperature). Each bar allows for the \
                   hold's own influence on the fit: a hold that no other hold checks has a short bar.";
    Figure::new("Magnitude residual of each hold", vec![panel], caption)
}
