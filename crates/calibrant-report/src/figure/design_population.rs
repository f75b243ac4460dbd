//! Figures of initial against optimal motions over many sensors: the thesis's Figures 9 to 11, 13 and 14.

use super::frame::caption;
use super::motion::{TIME, nodes};
use super::panel::{Panel, Points, Series, Shape};
use super::point_thinning::{drawn_in_words, every};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use crate::number_format::{self, significant, superscript};
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
    let panels = Panel::by_axis(axes, TIME, "acceleration (m/s²)", |axis, mut panel| {
        for (i, motion) in shown.iter().enumerate() {
            let (colour, dashes) = colour::look(i);
            let width = 1.1 + 5.0 * (1.0 - i as f64 / shown.len() as f64);
            let label = format!("sensor {}", i + 1);
            panel = panel.with(Series::stroke(&label, colour, (width, dashes), nodes(motion, axis)));
        }
        alike.push(counted(axis, &shown));
        match study.limits.axis(axis.index()).acceleration {
            Some(limit) if limit <= 4.0 * panel.largest() => panel.with_limits(limit),
            _ => panel,
        }
    });
    let caption = format!(
        "Is there one best motion? Each later line is thinner, which keeps lines visible where they coincide. {} A motion, its \
         mirror image, and the same motion on another axis with the same limits give the same information. If only these appear, there is one \
         best motion. The thesis finds this too. Its curves look sinusoidal. \
         Other curves follow from other limits. The thesis starts each design from one motion. Here each is the best of {}.",
        alike.join(" "),
        number_format::counted(study.starts, "start")
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
    let pair = both(study, &sensors, |outcome| Some(outcome.trace));
    let least = values(&pair).filter(|trace| *trace > 0.0).fold(f64::INFINITY, f64::min);
    let exponent = if least.is_finite() { least.log10().floor() } else { 0.0 };
    let label = match exponent as i32 {
        0 => "trace of C".to_string(),
        exponent => format!("trace of C (10{})", superscript(exponent)),
    };
    let mut panel = against(Panel::new("", "sensor", label), pair, |trace| trace / 10f64.powf(exponent));
    panel.log_y = true;
    let trace = &study.trace;
    let caption = format!(
        "Sum of the variances of all biases and scale factors, in SI units, as each calibration states it. The axis is logarithmic. \
         Whatever the initial motion (from {} to {}), the optimal motions reach one level (median {}).{}",
        significant(trace.initial.least, 2),
        significant(trace.initial.most, 2),
        significant(trace.optimal.median, 3),
        drawn_in_words(study.outcomes.len(), sensors.len())
    );
    Figure::new(title, vec![panel], caption)
}

/// Absolute errors of each sensor's parameters, with both motions: biases (a), scale factors (b), and others
/// (c).
pub(crate) fn absolute_errors(title: &str, study: &DesignStudy) -> Figure {
    let sensors = every(study.outcomes.len(), MOST_SENSORS);
    let (mut panels, mut logarithmic) = (Vec::new(), false);
    for (letter, prefix) in [("a", "bias."), ("b", "scale."), ("c", "matrix.")] {
        let all = study.parameters.iter().enumerate();
        for (p, parameter) in all.filter(|(_, parameter)| parameter.name.starts_with(prefix)) {
            let pair = both(study, &sensors, |outcome| outcome.absolute_errors.get(p).copied());
            let unit = DisplayUnit::suited_to(parameter.unit, values(&pair));
            let wide = study.summary.get(p).is_some_and(|entry| entry.predicted.value > WIDE);
            logarithmic |= wide;
            let title = format!("({letter}) {}", parameter.name);
            let panel = Panel::new(title, "sensor", unit.label("|estimate − truth|"));
            panels.push(against(panel, pair, |error| error * unit.factor).log_or_from_zero(wide));
        }
    }
    let caption = caption(
        "Distance of each estimate from the truth. With the optimal motion, errors are smaller on average by the factors of \
         the table above. Single sensors may be lucky with a poor motion.",
        &[(
            logarithmic,
            "Axes are logarithmic if the two motions differ by more than a factor of four. The axes of the thesis are linear.",
        )],
    );
    let columns = if study.parameters.len() == 2 { 2 } else { 3 };
    let caption = caption + &drawn_in_words(study.outcomes.len(), sensors.len());
    Figure::new(title, panels, caption).with_columns(columns)
}

/// A number of each of these sensors, with the initial and with the optimal motion.
fn both(study: &DesignStudy, sensors: &[usize], of: impl Fn(&MotionOutcome) -> Option<f64>) -> [Points; 2] {
    let with = |motion: fn(&DesignOutcome) -> &MotionOutcome| {
        let point = |&i: &usize| Some(((i + 1) as f64, of(motion(&study.outcomes[i]))?));
        sensors.iter().filter_map(point).collect()
    };
    [with(|outcome| &outcome.initial), with(|outcome| &outcome.optimal)]
}

fn values(pair: &[Points; 2]) -> impl Iterator<Item = f64> {
    pair.iter().flatten().map(|point| point.1)
}

/// The panel with both motions, their numbers in its unit.
fn against(panel: Panel, pair: [Points; 2], in_unit: impl Fn(f64) -> f64) -> Panel {
    named(panel, "initial motion", pair, in_unit)
}

/// The same, with a name for the first motion.
pub(super) fn named(
    panel: Panel,
    first: &str,
    [initial, optimal]: [Points; 2],
    in_unit: impl Fn(f64) -> f64,
) -> Panel {
    let scaled = |points: Points| points.into_iter().map(|(x, y)| (x, in_unit(y))).collect();
    panel.with(Series::dots(first, colour::BLUE, (Shape::Circle, 3.0), scaled(initial))).with(Series::dots(
        "optimal motion",
        colour::VERMILLION,
        (Shape::Square, 3.0),
        scaled(optimal),
    ))
}
