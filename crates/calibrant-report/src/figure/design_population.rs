//! Figures of initial against optimal motions over many sensors: the thesis's Figures 9 to 11, 13 and 14.

use super::motion::{TIME, nodes};
use super::panel::{Mark, Panel, Series, Shape};
use super::point_thinning::every;
use super::unit::DisplayUnit;
use super::{Figure, colour};
use crate::number_format;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::Axis;
use calibrant_study::{DesignOutcome, DesignStudy, MotionOutcome};

/// Largest number of sensors that are drawn one by one.
const MOST_SENSORS: usize = 200;
/// Above this ratio of largest to smallest, an axis is logarithmic.
const WIDE: f64 = 4.0;
/// Motions that differ by less than this share of their peak are the same.
const SAME: f64 = 0.01;

/// The optimal accelerations of several sensors on top of each other.
pub(crate) fn optimal_motions(title: &str, study: &DesignStudy, axes: &[Axis]) -> Figure {
    let shown: Vec<&JerkControlledMotion> =
        study.outcomes.iter().take(study.motions_shown).map(|outcome| &outcome.optimal.motion).collect();
    let mut alike = Vec::new();
    let panels = axes
        .iter()
        .map(|&axis| {
            let mut panel = Panel::new(format!("axis {axis}"), TIME, "acceleration (m/s²)");
            for (i, motion) in shown.iter().enumerate() {
                let place = i as f64 / shown.len() as f64;
                let (colour, dashes) = colour::look(i);
                let mark = Mark::Line { width: 1.1 + 5.0 * (1.0 - place), dashes };
                let label = format!("sensor {}", i + 1);
                panel = panel.with(Series::new(&label, colour, mark, nodes(motion, axis)));
            }
            alike.push(counted(axis, &shown));
            if let Some(limit) = study.limits.axis(axis.index()).acceleration
                && limit <= 4.0 * panel.largest()
            {
                panel = panel.with_limits(limit);
            }
            panel
        })
        .collect();
    let caption = format!(
        "Is there one best motion? Each later line is thinner, which keeps lines visible where they coincide. {} A motion, its \
         mirror image, and the same motion on another axis with the same limits give the same information. If only these appear, there is one \
         best motion. The thesis finds this too. Its curves look sinusoidal. \
         Other curves follow from other limits. The thesis starts each design from one motion. Here each is the best of {} start{}.",
        alike.join(" "),
        study.starts,
        if study.starts == 1 { "" } else { "s" }
    );
    let columns = if axes.len() == 1 { 1 } else { 3 };
    Figure::new(title, panels, caption).with_columns(columns)
}

/// The number of motions on this axis that equal the first one or its mirror image, in words.
fn counted(axis: Axis, motions: &[&JerkControlledMotion]) -> String {
    let values = |motion: &JerkControlledMotion| -> Vec<f64> {
        motion.acceleration_mps2().iter().map(|a| a[axis.index()]).collect()
    };
    let Some(first) = motions.first().map(|motion| values(motion)) else { return String::new() };
    let peak = first.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let distance = |other: &[f64], sign: f64| {
        other.iter().zip(&first).fold(0.0_f64, |most, (a, b)| most.max((a - sign * b).abs()))
    };
    let (mut same, mut mirrored) = (0, 0);
    for other in motions.iter().map(|motion| values(motion)) {
        if distance(&other, 1.0) <= SAME * peak {
            same += 1;
        } else if distance(&other, -1.0) <= SAME * peak {
            mirrored += 1;
        }
    }
    let others = motions.len() - same - mirrored;
    format!("Axis {axis}: {same} like sensor 1 (within 1 %), {mirrored} mirrored, {others} otherwise.")
}

/// The trace of the covariance of each sensor, with both motions.
pub(crate) fn traces(title: &str, study: &DesignStudy) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_SENSORS);
    let values = |of: fn(&DesignOutcome) -> &MotionOutcome| {
        sensors.iter().map(|&i| (i, of(&study.outcomes[i]).trace)).collect::<Vec<_>>()
    };
    let (initial, optimal) = (values(|o| &o.initial), values(|o| &o.optimal));
    let least = initial
        .iter()
        .chain(&optimal)
        .map(|point| point.1)
        .filter(|trace| *trace > 0.0)
        .fold(f64::INFINITY, f64::min);
    let exponent = if least.is_finite() { least.log10().floor() } else { 0.0 };
    let points = |values: Vec<(usize, f64)>| {
        values.into_iter().map(|(i, trace)| ((i + 1) as f64, trace / 10f64.powf(exponent))).collect()
    };
    let label = match exponent as i32 {
        0 => "trace of C".to_string(),
        exponent => format!("trace of C (10{})", number_format::superscript(exponent)),
    };
    let mut panel = Panel::new("", "sensor", label)
        .with(dots("initial motion", colour::BLUE, Shape::Circle, points(initial)))
        .with(dots("optimal motion", colour::VERMILLION, Shape::Square, points(optimal)));
    panel.log_y = true;
    let trace = &study.trace;
    let caption = format!(
        "Sum of the variances of all biases and scale factors, in SI units, as each calibration states it. The axis is logarithmic. \
         Whatever the initial motion (from {} to {}), the optimal motions reach one level (median {}).{}",
        number_format::significant(trace.initial.least, 2),
        number_format::significant(trace.initial.most, 2),
        number_format::significant(trace.optimal.median, 3),
        subset(study.outcomes.len(), sensors.len())
    );
    Figure::new(title, vec![panel], caption)
}

/// Absolute errors of each sensor's parameters, with both motions: biases (a), scale factors (b), and others
/// (c).
pub(crate) fn absolute_errors(title: &str, study: &DesignStudy) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_SENSORS);
    let mut panels = Vec::new();
    let mut logarithmic = false;
    for (letter, prefix) in [("a", "bias."), ("b", "scale."), ("c", "matrix.")] {
        for (p, parameter) in study.parameters.iter().enumerate() {
            if !parameter.name.starts_with(prefix) {
                continue;
            }
            let values = |of: fn(&DesignOutcome) -> &MotionOutcome| {
                sensors
                    .iter()
                    .map(|&i| (i, of(&study.outcomes[i]).absolute_errors.clone()))
                    .filter_map(|(i, errors)| errors.get(p).map(|&error| (i, error)))
                    .collect::<Vec<_>>()
            };
            let (initial, optimal) = (values(|o| &o.initial), values(|o| &o.optimal));
            let all = initial.iter().chain(&optimal).map(|point| point.1);
            let unit = DisplayUnit::suited_to(parameter.unit, all);
            let points = |values: Vec<(usize, f64)>| {
                values.into_iter().map(|(i, error)| ((i + 1) as f64, error * unit.factor)).collect()
            };
            let wide = study.summary.get(p).is_some_and(|entry| entry.predicted.value > WIDE);
            logarithmic |= wide;
            let title = format!("({letter}) {}", parameter.name);
            let mut panel = Panel::new(title, "sensor", unit.label("|estimate − truth|"))
                .with(dots("initial motion", colour::BLUE, Shape::Circle, points(initial)))
                .with(dots("optimal motion", colour::VERMILLION, Shape::Square, points(optimal)));
            if wide {
                panel.log_y = true;
            } else {
                panel.y_includes.push(0.0);
            }
            panels.push(panel);
        }
    }
    let mut caption = "Distance of each estimate from the truth. With the optimal motion, errors are smaller on average by the factors of \
                       the table above. Single sensors may be lucky with a poor motion."
        .to_string();
    if logarithmic {
        caption.push_str(" Axes are logarithmic if the two motions differ by more than a factor of four. The axes of the thesis are linear.");
    }
    caption.push_str(&subset(study.outcomes.len(), sensors.len()));
    let columns = if study.parameters.len() == 2 { 2 } else { 3 };
    Figure::new(title, panels, caption).with_columns(columns)
}

fn dots(label: &str, colour: &'static str, shape: Shape, points: Vec<(f64, f64)>) -> Series {
    Series::new(label, colour, Mark::Dots { shape, radius: 3.0 }, points)
}

fn subset(all: usize, drawn: usize) -> String {
    if drawn == all {
        return String::new();
    }
    format!(" Of {} sensors, {drawn} spread evenly over the list are drawn.", number_format::count(all))
}
