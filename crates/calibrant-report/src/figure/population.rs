//! Figures of a population of sensors: the thesis's Figure 6 and the errors behind it.

use super::histogram::{Histogram, bin_count, normal_curve};
use super::kinds::{Kind, kinds, look};
use super::panel::{Mark, Panel, Points, Series, Shape};
use super::point_thinning::{drawn_in_words, every};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::sensor::Parameter;
use calibrant_study::Study;

/// Largest number of sensors that are drawn one by one.
const MOST_POINTS: usize = 500;
/// Largest number of sensors that are drawn with error bars.
const MOST_BARS: usize = 150;

/// Estimated against true parameters, biases left and scale factors right: the thesis's Figure 6.
pub(crate) fn parameters_against_truth(study: &Study) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_POINTS);
    let error = |value: f64, p: usize| value - study.parameters[p].nominal.unwrap_or(0.0);
    let panel = |kind: Kind| {
        let values = kind.members.iter().flat_map(|&p| study.outcomes.iter().map(move |o| (p, o)));
        let truths = values.filter_map(|(p, o)| o.truth.get(p).map(|&v| error(v, p)));
        let unit = DisplayUnit::suited_to(kind.unit, truths);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut dots = Vec::new();
        for (position, &p) in kind.members.iter().enumerate() {
            let points: Points = sensors
                .iter()
                .filter_map(|&i| study.outcomes[i].truth.get(p).zip(study.outcomes[i].values.get(p)))
                .map(|(&truth, &value)| (error(truth, p) * unit.factor, error(value, p) * unit.factor))
                .filter(|point| point.0.is_finite() && point.1.is_finite())
                .collect();
            for (x, y) in &points {
                (low, high) = (low.min(*x).min(*y), high.max(*x).max(*y));
            }
            let (colour, shape) = look(position);
            let label = match kind.suffix(&study.parameters[p]) {
                axis if axis.len() == 1 => format!("axis {axis}"),
                axes => axes.to_string(),
            };
            dots.push(Series::dots(&label, colour, (shape, 3.0), points));
        }
        let label = |of: &str| unit.label(&format!("{of} − nominal"));
        let mut panel = Panel::new(format!("{} error", kind.name), label("true value"), label("estimate"));
        panel.square = true;
        if low <= high {
            let line = vec![(low, low), (high, high)];
            panel = panel.with(Series::stroke("estimate = truth", colour::GREY, (1.0, ""), line));
        }
        dots.into_iter().fold(panel, Panel::with)
    };
    let panels: Vec<Panel> = kinds(&study.parameters).into_iter().map(panel).collect();
    let caption = format!(
        "One marker for each sensor and axis. Good: all on the line. Errors much smaller than the spread of the sensors cannot be \
         seen here. The next figure shows them.{}",
        drawn_in_words(study.outcomes.len(), sensors.len())
    );
    let columns = if panels.len() > 2 { 3 } else { 2 };
    Figure::new("Figure 6 of the thesis: actual and estimated parameter errors", panels, caption)
        .with_columns(columns)
}

/// Estimate less truth of each sensor with its stated uncertainty.
pub(crate) fn parameter_errors(study: &Study) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_BARS);
    let panel = |(p, parameter): (usize, &Parameter)| {
        let drawn = || {
            let of = |&i: &usize| {
                let o = &study.outcomes[i];
                Some(((i + 1) as f64, o.values.get(p)? - o.truth.get(p)?, 2.0 * o.sd.get(p)?))
            };
            sensors.iter().filter_map(of)
        };
        let unit = DisplayUnit::suited_to(parameter.unit, drawn().map(|(_, error, bar)| error.abs() + bar));
        let points: Points = drawn().map(|(x, error, _)| (x, error * unit.factor)).collect();
        let spread = drawn().map(|(_, _, bar)| bar * unit.factor).collect();
        let ends = points.first().zip(points.last()).map(|(a, b)| vec![(a.0, 0.0), (b.0, 0.0)]);
        Panel::new(parameter.name.as_str(), "sensor", unit.label("estimate − truth"))
            .with(Series::bars("±2 sd as stated", colour::SKY, points.clone(), spread))
            .with(Series::stroke("zero", colour::BLACK, (1.0, ""), ends.unwrap_or_default()))
            .with(Series::dots("estimate − truth", colour::VERMILLION, (Shape::Circle, 2.2), points))
    };
    let panels: Vec<Panel> = study.parameters.iter().enumerate().map(panel).collect();
    let caption = format!(
        "The error of each estimate with the uncertainty that its calibration states. Good: nineteen in twenty bars cross zero, \
         and the points lie evenly on both sides of it.{}",
        drawn_in_words(study.outcomes.len(), sensors.len())
    );
    let columns = if study.parameters.len() == 2 { 2 } else { 3 };
    Figure::new("Errors of the estimates, sensor by sensor", panels, caption).with_columns(columns)
}

/// Histogram of the fits' p-values with the flat line that is expected; `None` where no fit has one.
pub(crate) fn p_values(study: &Study) -> Option<Figure> {
    let values: Vec<f64> =
        study.outcomes.iter().filter_map(|o| o.p_value).filter(|p| p.is_finite()).collect();
    if values.is_empty() {
        return None;
    }
    let bins = Histogram::within(&values, 0.0, 1.0, if values.len() < 200 { 10 } else { 20 });
    let expected = values.len() as f64 * bins.width;
    let spread = 2.0 * (expected * (1.0 - bins.width)).sqrt();
    let ends = vec![(0.0, expected), (1.0, expected)];
    let chance = vec![spread.min(expected); 2];
    let panel = Panel::new("", "p-value of the fit", "number of sensors")
        .with(Series::band("±2 sd of chance", colour::ORANGE, ends.clone(), chance))
        .with(Series::new("sensors", colour::SKY, Mark::Area, bins.outline()))
        .with(Series::dashed("expected", colour::VERMILLION, ends));
    let caption = "Good: flat, apart from chance. A peak at 0 means that model or noise do not describe the data, one at 1 that the \
                   assumed noise is too large.";
    Some(Figure::new("p-values of the fits", vec![panel], caption))
}

/// Histogram of all errors in stated standard deviations with the standard normal curve; `None` where there is none.
pub(crate) fn standardised_errors(study: &Study) -> Option<Figure> {
    let all = study.outcomes.iter().flat_map(|o| o.values.iter().zip(&o.truth).zip(&o.sd));
    let values: Vec<f64> =
        all.map(|((value, truth), sd)| (value - truth) / sd).filter(|z| z.is_finite()).collect();
    let reach = values.iter().fold(3.5_f64, |most, z| most.max(z.abs())).min(6.0);
    if values.is_empty() {
        return None;
    }
    let bins = Histogram::within(&values, -reach, reach, (2 * bin_count(values.len()) / 2).max(10));
    let curve = normal_curve(values.len() as f64 * bins.width, 1.0, reach);
    let panel = Panel::new("", "error in stated standard deviations", "number of estimates")
        .with(Series::new("all parameters and sensors", colour::SKY, Mark::Area, bins.outline()))
        .with(Series::line("standard normal curve", colour::VERMILLION, curve));
    let caption = "Good: the bars follow the curve. A wider histogram means that the stated standard deviations are too small. Errors \
                   beyond six are counted in the outer bars.";
    Some(Figure::new("Errors in standard deviations", vec![panel], caption))
}
