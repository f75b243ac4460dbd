//! Each parameter over the order of the recordings, with its control limits.

use super::super::panel::{Panel, Points, Series, Shape};
use super::super::point_thinning::{drawn_in_words, every};
use super::super::unit::DisplayUnit;
use super::super::{Figure, colour, frame};
use super::groups::groups;
use super::reach::{Reach, least_width, median, whole_step};
use crate::batch::{Batch, Control};
use crate::number_format::{count, significant};
use calibrant_core::diagnostic::Usability;

/// From this number of sensors on, control limits are reliable.
const RELIABLE: usize = 20;
/// The share of a normal distribution beyond three standard deviations.
const BEYOND_BY_CHANCE: f64 = 0.0027;
/// Half the length of an error bar, in standard deviations.
const BAR_SD: f64 = 2.0;
/// The most sensors that are drawn with error bars, and one by one.
const MOST_BARS: usize = 150;
const MOST_POINTS: usize = 600;
/// The heading under which the page lists the sensors in their order.
pub(crate) const SENSORS: &str = "All sensors";
/// The most sensors that are named for a parameter.
const MOST_NAMES: usize = 5;

/// The figures, and sentences on what they show.
pub(crate) struct Drifts {
    pub(crate) figures: Vec<Figure>,
    pub(crate) findings: Vec<String>,
}

/// A sensor that has the parameter.
struct Point {
    /// Its place in the batch, from 0.
    number: usize,
    value: f64,
    sd: f64,
    usability: Usability,
}

/// A figure for each sensor of an IMU, a panel for each of its parameters. None for a single result.
pub(crate) fn drifts(batch: &Batch) -> Drifts {
    let mut drifts = Drifts { figures: Vec::new(), findings: Vec::new() };
    let (mut beyond, mut checked, mut fewest) = (Vec::new(), 0, usize::MAX);
    for group in groups(batch) {
        let (mut panels, mut seen) = (Vec::new(), Seen::default());
        for &place in &group.members {
            let points = points(batch, place);
            if points.len() < 2 {
                continue;
            }
            let control = Control::of(batch, place);
            if let Some(control) = control {
                checked += control.sensors;
                fewest = fewest.min(control.sensors);
                beyond.extend(control.beyond(batch, place).into_iter().map(|number| (place, number)));
            }
            panels.push(panel(batch, place, &points, control, &mut seen));
        }
        if !panels.is_empty() {
            drifts.figures.push(Figure::new(group.name, panels, caption(batch, &seen)).with_columns(3));
        }
    }
    if checked > 0 {
        drifts.findings.push(in_words(batch, &beyond, checked, fewest));
    }
    drifts
}

/// What the caption of a figure explains: what its panels draw, and what is beyond their axes.
#[derive(Debug, Default)]
struct Seen {
    control: bool,
    outside: bool,
    /// Limits beyond an axis, with their parameter and values.
    far: Vec<String>,
}

fn caption(batch: &Batch, seen: &Seen) -> String {
    let always = match seen.control {
        false => "Good: no pattern.",
        true => {
            "Control limits are the mean ± 2.66 times the mean difference of neighbours, without sensors whose calibration is bad (individuals chart, \
             ISO 7870-2). Good: no pattern, and hardly a sensor beyond them."
        }
    };
    let far = format!("Too far away to be drawn: {}.", seen.far.join("; "));
    let outside = "Sensors outside the axis are crosses at its edge.";
    let caption = frame::caption(always, &[(!seen.far.is_empty(), &far), (seen.outside, outside)]);
    caption + &drawn_in_words(batch.sensors.len(), batch.sensors.len().min(MOST_POINTS))
}

fn points(batch: &Batch, place: usize) -> Vec<Point> {
    let point = |(number, sensor): (usize, &crate::batch::BatchSensor)| {
        let (value, sd) = sensor.estimate(place)?;
        Some(Point { number, value, sd, usability: sensor.usability()? })
    };
    batch.sensors.iter().enumerate().filter_map(point).collect()
}

fn panel(batch: &Batch, place: usize, points: &[Point], control: Option<Control>, seen: &mut Seen) -> Panel {
    let parameter = &batch.parameters[place];
    let name = parameter.name.as_str();
    let of = |f: fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let (values, sds) = (of(|of| of.value), of(|of| of.sd));
    let bulk = Reach::of(&values, least_width(&values, &sds)).unwrap_or(Reach { low: -1.0, high: 1.0 });
    let has_bars = points.len() <= MOST_BARS;
    // the bars of most sensors are whole
    let bulk = bulk.widened(if has_bars { BAR_SD * median(&sds).unwrap_or(0.0) } else { 0.0 });
    let near = |ends: &[f64; 2]| bulk.with(ends).is_some();
    let (control, limits) = (control.map(Control::ends), parameter.accepted.map(|(low, high)| [low, high]));
    let [drawn_control, drawn_limits] = [control, limits].map(|ends| ends.filter(near));
    let reach = [drawn_control, drawn_limits].into_iter().flatten().flatten().fold(bulk, Reach::including);
    let unit = DisplayUnit::suited_to(parameter.unit, [reach.low, reach.high]);
    let factor = unit.factor;
    seen.control |= control.is_some();
    for (kind, ends) in [("control limits", control), ("acceptance limits", limits)] {
        if let Some(ends) = ends.filter(|ends| !near(ends)) {
            let [low, high] = ends.map(|end| significant(end * factor, 3));
            seen.far
                .push(format!("the {kind} of {name}, {low} to {high} {}", unit.symbol).trim_end().to_owned());
        }
    }
    let last = batch.sensors.len() as f64;
    let level = |label: &str, colour, stroke, y: f64| {
        Series::stroke(label, colour, stroke, vec![(1.0, y * factor), (last.max(2.0), y * factor)])
    };

    let mut panel = Panel::new(name, "order of the recordings", unit.label("estimate"));
    let drawn: Vec<&Point> = every(points.len(), MOST_POINTS).iter().map(|&k| &points[k]).collect();
    panel.y_shown = Some((reach.low * factor, reach.high * factor));
    let inside = || drawn.iter().filter(|of| reach.contains(of.value));
    let at = |of: &&Point| ((of.number + 1) as f64, of.value.clamp(reach.low, reach.high) * factor);
    if has_bars {
        // those of sensors outside the axis are cut away, but their values are seen under the pointer
        let bars = drawn.iter().filter(|of| of.sd.is_finite());
        let bar = |of: &&Point| (((of.number + 1) as f64, of.value * factor), BAR_SD * of.sd * factor);
        let (centres, spread) = bars.map(bar).unzip();
        panel = panel.with(Series::bars("±2 sd", colour::SKY, centres, spread));
    }
    if let Some([low, high]) = drawn_control {
        panel = panel.with(level("mean", colour::GREY, (1.0, ""), 0.5 * (low + high)));
        for (label, y) in [("control limits", low), ("", high)] {
            panel = panel.with(level(label, colour::GREY, (1.4, "3 3"), y));
        }
    }
    if let Some([low, high]) = drawn_limits {
        for (label, y) in [("acceptance limits", low), ("", high)] {
            panel = panel.with(level(label, colour::BLACK, (1.6, "7 4"), y));
        }
    }
    let looks = [
        (Usability::Ok, colour::BLUE, Shape::Circle),
        (Usability::Doubtful, colour::ORANGE, Shape::Triangle),
        (Usability::Bad, colour::VERMILLION, Shape::Square),
    ];
    for (usability, colour, shape) in looks {
        let dots: Points = inside().filter(|of| of.usability == usability).map(at).collect();
        if !dots.is_empty() {
            panel = panel.with(Series::dots(usability.name(), colour, (shape, 3.0), dots));
        }
    }
    let outside: Points = drawn.iter().filter(|of| !reach.contains(of.value)).map(at).collect();
    if !outside.is_empty() {
        seen.outside = true;
        let crosses = Series::dots("outside the axis", colour::VERMILLION, (Shape::Cross, 4.0), outside);
        panel = panel.with(crosses);
    }
    panel.x_step = Some(whole_step(batch.sensors.len()));
    panel.x_names = SENSORS;
    panel
}

/// The sensors beyond the control limits, and how many chance alone would put there.
fn in_words(batch: &Batch, beyond: &[(usize, usize)], checked: usize, fewest: usize) -> String {
    let of_parameter = |place: usize| {
        let numbers: Vec<usize> = beyond.iter().filter(|of| of.0 == place).map(|of| of.1).collect();
        if numbers.is_empty() {
            return None;
        }
        let named: Vec<&str> =
            numbers.iter().take(MOST_NAMES).map(|&number| batch.sensors[number].name.as_str()).collect();
        let further = numbers.len().saturating_sub(MOST_NAMES);
        let rest = if further > 0 { format!(" and {further} more") } else { String::new() };
        Some(format!("{} of {}{rest}", batch.parameters[place].name, named.join(", ")))
    };
    let found: Vec<String> = (0..batch.parameters.len()).filter_map(of_parameter).collect();
    let mut words = match found.as_slice() {
        [] => "No value is beyond its control limits.".to_owned(),
        found => format!(
            "Beyond the control limits: {}. That is {} of {} values; chance alone puts about {} there.",
            found.join("; "),
            beyond.len(),
            count(checked),
            significant(BEYOND_BY_CHANCE * checked as f64, 2)
        ),
    };
    if fewest < RELIABLE {
        words.push_str(&format!(" Control limits of fewer than {RELIABLE} sensors are rough."));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::super::super::panel::Mark;
    use super::*;
    use crate::batch::{BatchParameter, BatchSensor};
    use calibrant_core::diagnostic::Verdict;

    /// Sensors with one parameter, a bias, of these values and standard deviations.
    fn batch(estimates: impl IntoIterator<Item = (f64, f64)>) -> Batch {
        let sensor = |(number, estimate): (usize, (f64, f64))| BatchSensor {
            name: format!("s{number}"),
            link: None,
            station: None,
            recorded: None,
            verdict: Ok(Verdict::on([], &[])),
            quality: Vec::new(),
            codes: Vec::new(),
            limits_failed: Vec::new(),
            reasons: Vec::new(),
            estimates: vec![estimate],
        };
        let parameter = BatchParameter {
            name: "accelerometer.bias.x".into(),
            unit: "m/s²",
            nominal: None,
            spread: None,
            accepted: None,
        };
        let sensors = estimates.into_iter().enumerate().map(sensor).collect();
        Batch { parameters: vec![parameter], sensors, ..Batch::default() }
    }

    fn only_panel(batch: &Batch) -> (Panel, Seen) {
        let (points, mut seen) = (points(batch, 0), Seen::default());
        let panel = panel(batch, 0, &points, Control::of(batch, 0), &mut seen);
        (panel, seen)
    }

    #[test]
    fn bars_that_the_axis_cuts_keep_their_ends() {
        let mut estimates: Vec<(f64, f64)> = (0..20).map(|k| (f64::from(k % 4), 0.1)).collect();
        estimates[7].1 = 50.0;
        let (panel, _) = only_panel(&batch(estimates));
        let bars = panel.series.iter().find(|of| of.mark == Mark::ErrorBars).expect("bars");
        assert_eq!((bars.points[7].1, bars.spread[7]), (3.0, 100.0));
        let [_, y] = panel.axes().expect("sensors").map(|axis| axis.range);
        assert!(y.1 - y.0 < 20.0, "{y:?}");
    }

    #[test]
    fn limits_that_are_not_drawn_are_stated() {
        let near = batch((0..20).map(|k| (f64::from(k % 4), 0.1)));
        let (panel, seen) = only_panel(&near);
        assert!(panel.series.iter().any(|of| of.label == "control limits") && seen.far.is_empty());

        // a fault of one sensor widens the limits, but not the axis
        let mut far = near.clone();
        far.sensors[7].estimates[0].0 = 1000.0;
        let (panel, seen) = only_panel(&far);
        assert!(panel.series.iter().all(|of| of.label != "control limits"));
        let caption = caption(&far, &seen);
        let stated =
            "Too far away to be drawn: the control limits of accelerometer.bias.x, −232 to 334 m/s².";
        assert!(caption.contains(stated) && caption.contains("crosses at its edge"), "{caption}");
    }

    #[test]
    fn a_caption_explains_what_is_drawn() {
        let few = batch((0..4).map(|k| (f64::from(k), 0.1)));
        let (_, seen) = only_panel(&few);
        let caption = caption(&few, &seen);
        assert!(!caption.contains("ontrol limits") && !caption.contains("crosses"), "{caption}");
    }
}
