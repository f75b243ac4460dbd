//! The figure of trajectories of several durations.

use super::kinds::look;
use super::panel::{Panel, Series};
use super::unit::DisplayUnit;
use super::{Figure, colour};

/// A curve: its name, its unit, and standard deviations by duration.
pub(crate) type DurationCurve = (String, &'static str, Vec<(f64, f64)>);

/// Standard deviations against the duration, a panel for each kind of parameters.
pub(crate) fn duration_curves(curves: &[DurationCurve]) -> Figure {
    let panel = |(place, (name, unit, points)): (usize, &DurationCurve)| {
        let unit = DisplayUnit::suited_to(unit, points.iter().map(|(_, sd)| *sd));
        let (colour, shape) = look(place);
        let scaled: Vec<(f64, f64)> = points.iter().map(|(t, sd)| (*t, sd * unit.factor)).collect();
        let mut panel = Panel::new(name.clone(), "duration (s)", unit.label("sd"))
            .with(Series::stroke("", colour, (1.6, ""), scaled.clone()))
            .with(Series::dots(name, colour, (shape, 3.6), scaled));
        // without other influence, sd goes down as the root of the duration: a line of slope −1/2
        if let (Some((t, sd)), Some((last, _))) = (points.first(), points.last()) {
            let ideal = [*t, *last].map(|time| (time, sd * (t / time).sqrt() * unit.factor)).to_vec();
            panel = panel.with(Series::dashed("∝ 1/√duration", colour::BLACK, ideal));
        }
        panel.log_x = true;
        panel.when_empty = "no trajectory was found".into();
        panel.log_or_from_zero(true)
    };
    let panels = curves.iter().enumerate().map(panel).collect();
    let caption = "Each marker is one design: the root mean square of the standard deviations of its kind. Dashed: what longer recording alone would give. Where a curve lies below it, \
         time also buys a better motion; where it lies above, something else than noise limits it. Axes are logarithmic.";
    Figure::new("Standard deviations against duration", panels, caption.to_owned()).with_columns(3)
}
