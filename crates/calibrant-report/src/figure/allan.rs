//! The Allan deviation plot.

use super::frame::caption;
use super::panel::{Panel, Points, Series, Shape};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::noise::{AxisNoise, PowerLaw, SensorNoise};

/// Number of points of a fitted line.
const LINE: usize = 60;
/// Label of a filter's share of the Allan variance.
const FILTER: &str = "share of a filter";

/// Allan deviation of each axis with its 95 % bounds, the fitted model and its processes.
pub(crate) fn allan_figure(noise: &SensorNoise) -> Figure {
    let highest = noise.axes.iter().flat_map(|axis| &axis.allan.points).map(|point| point.deviation);
    let unit = DisplayUnit::suited_to(noise.unit.symbol(), highest);
    let mut panels: Vec<Panel> = noise.axes.iter().map(|axis| panel(axis, unit)).collect();
    // the same range everywhere, so that a reader can compare the axes
    let extremes: Vec<f64> =
        panels.iter().filter_map(Panel::axes).flat_map(|[_, y]| [y.range.0, y.range.1]).collect();
    panels.iter_mut().for_each(|panel| panel.y_includes.clone_from(&extremes));
    let has_filter = |panel: &Panel| panel.series.iter().any(|series| series.label == FILTER);
    let any = |of: fn(&AxisNoise) -> bool| noise.axes.iter().any(of);
    let caption = caption(
        "Markers: overlapping Allan deviation. Band: its 95 % bounds, wide for cluster times with few clusters. Solid: the fit. \
         Dashed: its parts, each with its slope: −1 quantisation, −½ white noise (N is its value at 1 s), 0 bias instability (0.664 B), \
         +½ rate random walk (K √(τ/3)). A part that is drawn, but not determined in the table, is too uncertain for a value.",
        &[
            (
                panels.iter().any(has_filter),
                "The samples are filtered: slope −1 at short cluster times comes from the filter, not from quantisation.",
            ),
            (
                any(|axis| axis.fit.vibration.is_some()),
                "The markers include the vibration. The fit excludes it.",
            ),
            (
                any(|axis| axis.fit.drift.is_significant()),
                "A linear drift (slope +1) has its own line. It is not noise, and the fit excludes it.",
            ),
        ],
    );
    Figure::new(format!("Allan deviation of the {}", noise.sensor_kind), panels, caption).with_columns(2)
}

fn panel(axis: &AxisNoise, unit: DisplayUnit) -> Panel {
    let (fit, points) = (&axis.fit, &axis.allan.points);
    let (first, last) =
        (points.first().map_or(1.0, |point| point.tau_s), points.last().map_or(1.0, |point| point.tau_s));
    let curve = |f: &dyn Fn(f64) -> f64, from: f64, to: f64| -> Points {
        let tau = |i: usize| from * (to / from).powf(i as f64 / (LINE - 1) as f64);
        (0..LINE).map(|i| (tau(i), unit.factor * f(tau(i)))).collect()
    };
    let mut panel =
        Panel::new(format!("axis {}", axis.axis), "cluster time τ (s)", unit.label("Allan deviation σ"));
    (panel.log_x, panel.log_y) = (true, true);
    // a band is symmetric: about the middle of the bounds
    let middle =
        points.iter().map(|point| (point.tau_s, 0.5 * unit.factor * (point.low + point.high))).collect();
    let half = points.iter().map(|point| 0.5 * unit.factor * (point.high - point.low)).collect();
    let marks = points.iter().map(|point| (point.tau_s, unit.factor * point.deviation)).collect();
    panel = panel.with(Series::band("95 % bounds", colour::SKY, middle, half)).with(Series::dots(
        "Allan deviation",
        colour::BLUE,
        (Shape::Circle, 2.2),
        marks,
    ));

    let lowest = 0.5 * unit.factor * points.iter().map(|point| point.low).fold(f64::INFINITY, f64::min);
    let part = |f: &dyn Fn(f64) -> f64| -> Points {
        curve(f, first, last).into_iter().filter(|point| point.1 > lowest).collect()
    };
    let shortest = if fit.filtered { FILTER } else { "quantisation Q" };
    for (process, label, colour) in [
        (PowerLaw::Quantisation, shortest, colour::GREY),
        (PowerLaw::White, "white noise N", colour::GREEN),
        (PowerLaw::Flicker, "bias instability B", colour::ORANGE),
        (PowerLaw::RandomWalk, "rate random walk K", colour::VERMILLION),
    ] {
        let part = part(&|tau| fit.model.share(process, tau));
        if part.len() > 1 {
            panel = panel.with(Series::stroke(label, colour, (1.4, "5 4"), part));
        }
    }
    if fit.drift.is_significant() {
        let part = part(&|tau| fit.drift.allan_deviation(tau));
        panel = panel.with(Series::stroke("linear drift", colour::GREY, (1.4, "1 3"), part));
    }
    let fitted = curve(&|tau| fit.model.deviation(tau), fit.shortest_tau_s, fit.longest_tau_s);
    panel.with(Series::line("fit", colour::BLACK, fitted))
}
