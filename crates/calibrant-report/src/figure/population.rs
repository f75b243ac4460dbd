//! Figures of a population of sensors: the thesis's Figure 6 and the errors behind it.

use super::panel::{Mark, Panel, Series, Shape};
use super::point_thinning::every;
use super::residuals::{Histogram, bin_count};
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
    let panels: Vec<Panel> = groups(study)
        .into_iter()
        .map(|group| {
            let error = |value: f64, index: usize| value - study.parameters[index].nominal.unwrap_or(0.0);
            let values = group.members.iter().flat_map(|&p| study.outcomes.iter().map(move |o| (p, o)));
            let unit = DisplayUnit::suited_to(
                group.unit,
                values.filter_map(|(p, o)| o.truth.get(p).map(|&v| error(v, p))),
            );
            let mut panel = Panel {
                square: true,
                ..Panel::new(
                    format!("{} error", group.name),
                    unit.label("true value − nominal"),
                    unit.label("estimate − nominal"),
                )
            };
            let mut ends: Option<(f64, f64)> = None;
            for (position, &p) in group.members.iter().enumerate() {
                let points: Vec<(f64, f64)> = sensors
                    .iter()
                    .map(|&i| &study.outcomes[i])
                    .filter_map(|o| o.truth.get(p).zip(o.values.get(p)))
                    .map(|(&truth, &value)| (error(truth, p) * unit.factor, error(value, p) * unit.factor))
                    .filter(|point| point.0.is_finite() && point.1.is_finite())
                    .collect();
                for point in &points {
                    let (low, high) = ends.unwrap_or(*point);
                    ends = Some((low.min(point.0).min(point.1), high.max(point.0).max(point.1)));
                }
                panel = panel.with(axis_dots(position, group.suffix(study, p), points));
            }
            if let Some((low, high)) = ends {
                let mark = Mark::Line { width: 1.0, dashes: "" };
                panel.series.insert(
                    0,
                    Series::new("estimate = truth", colour::GREY, mark, vec![(low, low), (high, high)]),
                );
            }
            panel
        })
        .collect();
    let caption = format!(
        "One marker for each sensor and axis. Good: all on the line. Errors much smaller than the spread of the sensors cannot be \
         seen here. The next figure shows them.{}",
        subset(study, sensors.len())
    );
    let columns = if panels.len() > 2 { 3 } else { 2 };
    Figure::new("Figure 6 of the thesis: actual and estimated parameter errors", panels, caption)
        .with_columns(columns)
}

/// Estimate less truth of each sensor with its stated uncertainty.
pub(crate) fn parameter_errors(study: &Study) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_BARS);
    let panels: Vec<Panel> = study
        .parameters
        .iter()
        .enumerate()
        .map(|(p, parameter)| {
            let drawn = || {
                sensors
                    .iter()
                    .map(|&i| (i, &study.outcomes[i]))
                    .filter(move |(_, o)| p < o.truth.len() && p < o.values.len() && p < o.sd.len())
            };
            let largest = drawn().map(|(_, o)| (o.values[p] - o.truth[p]).abs() + 2.0 * o.sd[p]);
            let unit = DisplayUnit::suited_to(parameter.unit, largest);
            let points: Vec<_> =
                drawn().map(|(i, o)| ((i + 1) as f64, (o.values[p] - o.truth[p]) * unit.factor)).collect();
            let spread = drawn().map(|(_, o)| 2.0 * o.sd[p] * unit.factor).collect();
            let ends = points
                .first()
                .zip(points.last())
                .map(|(a, b)| vec![(a.0, 0.0), (b.0, 0.0)])
                .unwrap_or_default();
            Panel::new(parameter.name.as_str(), "sensor", unit.label("estimate − truth"))
                .with(
                    Series::new("±2 sd as stated", colour::SKY, Mark::ErrorBars, points.clone())
                        .with_spread(spread),
                )
                .with(Series::new("zero", colour::BLACK, Mark::Line { width: 1.0, dashes: "" }, ends))
                .with(Series::dots("estimate − truth", colour::VERMILLION, Shape::Circle, points))
        })
        .collect();
    let caption = format!(
        "The error of each estimate with the uncertainty that its calibration states. Good: nineteen in twenty bars cross zero, \
         and the points lie evenly on both sides of it.{}",
        subset(study, sensors.len())
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
    let panel =
        Panel::new("", "p-value of the fit", "number of sensors")
            .with(
                Series::new("±2 sd of chance", colour::ORANGE, Mark::Band, ends.clone())
                    .with_spread(vec![spread.min(expected); 2]),
            )
            .with(Series::new("sensors", colour::SKY, Mark::Area, bins.outline()))
            .with(Series::dashed("expected", colour::VERMILLION, ends));
    let caption = "Good: flat, apart from chance. A peak at 0 means that model or noise do not describe the data, one at 1 that the \
                   assumed noise is too large.";
    Some(Figure::new("p-values of the fits", vec![panel], caption))
}

/// Histogram of all errors in stated standard deviations with the standard normal curve; `None` where there is none.
pub(crate) fn standardised_errors(study: &Study) -> Option<Figure> {
    let values: Vec<f64> = study
        .outcomes
        .iter()
        .flat_map(|o| {
            o.values.iter().zip(&o.truth).zip(&o.sd).map(|((value, truth), sd)| (value - truth) / sd)
        })
        .filter(|z| z.is_finite())
        .collect();
    let reach = values.iter().fold(3.5_f64, |most, z| most.max(z.abs())).min(6.0);
    if values.is_empty() {
        return None;
    }
    let bins = Histogram::within(&values, -reach, reach, (2 * bin_count(values.len()) / 2).max(10));
    let area = values.len() as f64 * bins.width;
    let curve = (0..=120)
        .map(|i| reach * (f64::from(i) / 60.0 - 1.0))
        .map(|z| (z, area * (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()))
        .collect();
    let panel = Panel::new("", "error in stated standard deviations", "number of estimates")
        .with(Series::new("all parameters and sensors", colour::SKY, Mark::Area, bins.outline()))
        .with(Series::line("standard normal curve", colour::VERMILLION, curve));
    let caption = "Good: the bars follow the curve. A wider histogram means that the stated standard deviations are too small. Errors \
                   beyond six are counted in the outer bars.";
    Some(Figure::new("Errors in standard deviations", vec![panel], caption))
}

/// Parameters that share a panel.
struct Group {
    name: &'static str,
    unit: &'static str,
    members: Vec<usize>,
}

impl Group {
    fn suffix<'a>(&self, study: &'a Study, index: usize) -> &'a str {
        study.parameters[index].name.split_once('.').map_or("", |(_, suffix)| suffix)
    }
}

fn groups(study: &Study) -> Vec<Group> {
    [("bias.", "bias"), ("scale.", "scale factor"), ("matrix.", "cross-axis sensitivity")]
        .into_iter()
        .filter_map(|(prefix, name)| {
            let is_member = |parameter: &Parameter| parameter.name.starts_with(prefix);
            let members: Vec<usize> =
                (0..study.parameters.len()).filter(|&i| is_member(&study.parameters[i])).collect();
            let unit = study.parameters[*members.first()?].unit;
            Some(Group { name, unit, members })
        })
        .collect()
}

fn axis_dots(position: usize, suffix: &str, points: Vec<(f64, f64)>) -> Series {
    let looks = [
        (colour::BLUE, Shape::Circle),
        (colour::ORANGE, Shape::Square),
        (colour::GREEN, Shape::Triangle),
        (colour::VERMILLION, Shape::Cross),
        (colour::SKY, Shape::Circle),
        (colour::BLACK, Shape::Square),
    ];
    let (colour, shape) = looks[position % looks.len()];
    let label = if suffix.len() == 1 { format!("axis {suffix}") } else { suffix.to_string() };
    Series::new(&label, colour, Mark::Dots { shape, radius: 3.0 }, points)
}

fn subset(study: &Study, drawn: usize) -> String {
    let all = study.outcomes.len();
    if drawn < all {
        format!(
            " Of {} sensors, {drawn} spread evenly over the list are drawn.",
            crate::number_format::count(all)
        )
    } else {
        String::new()
    }
}
