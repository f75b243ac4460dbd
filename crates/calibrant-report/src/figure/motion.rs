//! Figures of the recovered motion: the thesis's Figures 4 and 5.

use super::frame::caption;
use super::panel::{Panel, Points, Series, Shape};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, RecoveredMotion};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::{Axis, Correction, ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;

pub(super) const TIME: &str = "time (s)";

/// Acceleration as measured, as estimated, and the true one where it is known: the thesis's Figure 4.
pub(crate) fn acceleration_figure(
    title: &str,
    calibration: &Calibration,
    recovered: &RecoveredMotion,
    recording: &Recording,
    truth: Option<&JerkControlledMotion>,
) -> Figure {
    let counts = calibration.unit(SensorKind::Accelerometer) == ReadingUnit::Counts;
    let correction = if counts { Correction::of(&calibration.imu[SensorKind::Accelerometer]) } else { None };
    let first = recovered.first_sample.min(recording.len());
    let end = match recovered.residuals.len() {
        0 => recording.len(),
        used => (first + used).min(recording.len()),
    };
    let gravity = recovered.gravity.map_or_else(Vector3::zeros, |gravity| gravity.force_mps2());
    let readings_label = match (counts, recovered.gravity) {
        (true, None) => "readings, corrected",
        (false, None) => "readings",
        (true, Some(_)) => "readings, corrected, less gravity",
        (false, Some(_)) => "readings, less gravity",
    };
    let recording = &*recovered.clock.on_motion_clock(recording);
    let panels = Panel::by_axis(recording.active_axes(), TIME, "acceleration (m/s²)", |axis, panel| {
        let value = |k: usize| {
            let reading = &recording.readings()[k];
            let value = correction.as_ref().map_or(*reading, |c| c.apply(reading)) - gravity;
            (recording.times_s()[k], value[axis.index()])
        };
        let used = if counts && correction.is_none() { 0..0 } else { first..end };
        let dots = thinned(used.map(value));
        let mut panel = panel.with(Series::dots(readings_label, colour::SKY, (Shape::Circle, 3.0), dots));
        if let Some(truth) = truth {
            panel = panel.with(Series::stroke("true", colour::BLACK, (2.6, ""), nodes(truth, axis)));
        }
        panel.with(Series::dashed("estimated", colour::VERMILLION, nodes(&recovered.motion, axis)))
    });
    let good = match (truth.is_some(), counts) {
        (true, _) => {
            "Good: the dashed line lies on the solid one. The readings differ from both by the sensor's bias and \
             scale error, which the calibration corrects."
        }
        (false, false) => {
            "Good: the estimated line follows the readings everywhere, apart from a constant shift (the bias) and a \
             small stretch (the scale)."
        }
        (false, true) => {
            "Good: the readings, converted to m/s² with the estimated parameters, lie on the estimated line."
        }
    };
    let thinned = "Only the smallest and the largest reading of each pixel column are drawn.";
    let caption = caption(good, &[(is_thinned(end.saturating_sub(first)), thinned)]);
    Figure::new(title, panels, caption)
}

/// Estimated less true acceleration with its stated uncertainty, or the uncertainty alone. `None` where
/// neither is known.
pub(crate) fn motion_error_figure(
    recovered: &RecoveredMotion,
    recording: &Recording,
    truth: Option<&JerkControlledMotion>,
) -> Option<Figure> {
    let sd = &recovered.acceleration_sd_mps2;
    let times = recovered.motion.times_s();
    let error = |i: usize, t: f64| {
        truth.map(|truth| recovered.motion.acceleration_mps2()[i] - truth.acceleration_at(t))
    };
    let errors: Vec<Vector3<f64>> =
        times.iter().enumerate().map(|(i, &t)| error(i, t).unwrap_or_else(Vector3::zeros)).collect();
    let largest =
        |list: &[Vector3<f64>]| list.iter().map(|v| v.amax()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let unit = DisplayUnit::suited("m/s²", largest(&errors).max(2.0 * largest(sd)));
    if largest(&errors).max(largest(sd)) == 0.0 {
        return None;
    }
    let label = unit.label(if truth.is_some() { "estimated − true" } else { "uncertainty" });
    let panels = Panel::by_axis(recording.active_axes(), TIME, &label, |axis, mut panel| {
        let a = axis.index();
        let spread: Vec<f64> = sd.iter().map(|sd| 2.0 * sd[a] * unit.factor).collect();
        if spread.len() == times.len() {
            let zero = times.iter().map(|&t| (t, 0.0)).collect();
            panel = panel.with(Series::band("±2 sd as stated", colour::SKY, zero, spread));
        }
        if truth.is_some() {
            let points = thinned(times.iter().zip(&errors).map(|(&t, e)| (t, e[a] * unit.factor)));
            let (red, label) = (colour::VERMILLION, "estimated − true at the nodes");
            panel = panel.with(Series::stroke("", red, (0.8, ""), points.clone())).with(Series::dots(
                label,
                red,
                (Shape::Circle, 2.2),
                points,
            ));
        }
        panel
    });
    let (title, caption) = if truth.is_some() {
        (
            "Error of the recovered acceleration",
            "Good: nearly all points lie within the band. Neighbouring points move together because errors of bias and \
             scale are common to all of them. Known ends have no error.",
        )
    } else {
        (
            "Uncertainty of the recovered acceleration",
            "The band is two standard deviations of each node's acceleration. It closes where the acceleration was known.",
        )
    };
    Some(Figure::new(title, panels, caption))
}

/// The states xᵢ and the inputs uᵢ of each interval, true and estimated: the thesis's Figure 5.
pub(crate) fn state_and_jerk_figure(
    title: &str,
    recovered: &RecoveredMotion,
    recording: &Recording,
    truth: Option<&JerkControlledMotion>,
) -> Figure {
    let quantity = |label: &str, of: fn(&JerkControlledMotion) -> Vec<Vector3<f64>>| {
        Panel::by_axis(recording.active_axes(), TIME, label, |axis, mut panel| {
            if let Some(truth) = truth {
                let points = steps(truth, &of(truth), axis);
                panel = panel.with(Series::stroke("true", colour::BLACK, (2.8, ""), points));
            }
            let estimate = steps(&recovered.motion, &of(&recovered.motion), axis);
            panel.with(Series::dashed("estimated", colour::VERMILLION, estimate))
        })
    };
    let mut panels = quantity("state xᵢ (m/s²)", JerkControlledMotion::intercept_mps2);
    panels.extend(quantity("input uᵢ (m/s³)", JerkControlledMotion::jerk_mps3));
    let columns = if recording.axes() == 1 { 2 } else { 3 };
    let good = if truth.is_some() { " Good: the dashed steps cover the solid ones." } else { "" };
    let caption = format!(
        "Acceleration in interval i is α(t) = xᵢ + uᵢ t. uᵢ is the jerk, and xᵢ the line's intercept at t = 0. The intercept grows with \
         the interval's distance from the start.{good}"
    );
    Figure::new(title, panels, caption).with_columns(columns)
}

pub(super) fn nodes(motion: &JerkControlledMotion, axis: Axis) -> Points {
    let values = motion.acceleration_mps2().iter().map(|a| a[axis.index()]);
    thinned(motion.times_s().iter().copied().zip(values))
}

pub(super) fn steps(motion: &JerkControlledMotion, values: &[Vector3<f64>], axis: Axis) -> Points {
    let ends = motion.times_s().windows(2);
    let points: Points =
        ends.zip(values).flat_map(|(ends, v)| [0, 1].map(|k| (ends[k], v[axis.index()]))).collect();
    thinned(points.into_iter())
}
