//! Figures of the readings before and after the correction.

use super::frame::caption;
use super::panel::{Mark, Panel, Points, Series, Shape};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, HoldCalibration, Uncalibrated};
use calibrant_core::sensor::{
    Axis, CalibratedImu, Correction, ImuCorrection, ImuRecording, Recording, SensorKind,
};
use nalgebra::Vector3;

const BEFORE: &str = "before";
const AFTER: &str = "after";

/// Magnitude of the mean reading of each hold less gravity. One panel has both before and after, another has
/// after alone. `None` without holds.
pub(crate) fn holds_before_and_after(holds: &HoldCalibration) -> Option<Figure> {
    let numbered = || (1..).map(f64::from).zip(&holds.holds);
    let before: Points = numbered()
        .filter_map(|(number, result)| Some((number, holds.magnitude_residual_before_mps2(&result.hold)?)))
        .collect();
    if before.is_empty() {
        return None;
    }
    let with_after = |panel: Panel, factor: f64| {
        let after = numbered()
            .map(|(number, result)| (result.used, (number, factor * result.magnitude_residual_mps2)));
        let panel = panel.with_used([AFTER, "after, not used"], [3.0, 4.5], after);
        panel.log_or_from_zero(false)
    };
    let both = Panel::new("before and after", "hold", "|f| − g (m/s²)")
        .with(Series::new("", colour::GREY, Mark::Stems, before.clone()))
        .with(Series::dots(BEFORE, colour::ORANGE, (Shape::Square, 3.0), before));
    let residuals = holds.holds.iter().map(|result| result.magnitude_residual_mps2);
    let unit = DisplayUnit::suited_to("m/s²", residuals);
    let alone = Panel::new("after alone", "hold", unit.label("|f| − g"));
    let caption = format!(
        "Magnitude of the mean reading of each hold less gravity. Before: {}. Good: on the left, the blue markers lie on zero, wherever the orange squares are (errors that depend on the \
         orientation). On the right, they scatter about zero without a pattern.",
        holds.before.source
    );
    let panels = vec![with_after(both, 1.0), with_after(alone, unit.factor)];
    Some(Figure::new("Gravity in each hold, before and after", panels, caption).with_columns(2))
}

/// Magnitude of the specific force over a whole recording, before and after. Of an IMU also the change of its
/// angular rate by the correction.
pub(crate) fn recording_before_and_after(
    calibration: &Calibration,
    holds: &HoldCalibration,
    recording: &ImuRecording,
) -> Option<Figure> {
    let accelerometer = recording[SensorKind::Accelerometer].as_ref()?;
    // the figure needs the values only, not their uncertainty
    let imu = CalibratedImu { covariance: None, ..calibration.calibrated() };
    let corrected = ImuCorrection::of(&imu).ok()?.apply(recording).ok()?;
    let forces = corrected.accelerometer?;
    let rates = || {
        rate_panels(
            &calibration.gyroscope.as_ref()?.before,
            &corrected.gyroscope?.values,
            recording[SensorKind::Gyroscope].as_ref()?,
        )
    };
    let (forces, rates) = rayon::join(|| force_panels(holds, &forces.values, accelerometer), rates);
    let before = match &calibration.gyroscope {
        None => format!("Before: {}.", holds.before.source),
        Some(of) => {
            format!("Before, accelerometer: {}; gyroscope: {}.", holds.before.source, of.before.source)
        }
    };
    let panels = forces?.into_iter().chain(rates.into_iter().flatten()).collect();
    let always = format!(
        "Magnitude of the specific force, of all samples and in the holds, where a bar reaches from the smallest to the largest. {before} Good: the blue line and all \
         blue bars lie about g, as wide as the noise of the samples."
    );
    let caption = caption(
        &always,
        &[
            (
                calibration.gyroscope.is_some(),
                "The correction of the gyroscope is far smaller than the rates, so its change is shown. At rest, only the g-sensitivity changes the rate. In rotations, misalignment \
             and gains change it, too.",
            ),
            (
                is_thinned(recording[SensorKind::Gyroscope].as_ref().unwrap_or(accelerometer).len()),
                "The smallest and the largest value of each pixel column are drawn.",
            ),
        ],
    );
    Some(Figure::new("The recording, before and after", panels, caption).with_columns(2))
}

/// The magnitude over time, in full and near gravity. `after` are the corrected readings.
fn force_panels(
    holds: &HoldCalibration,
    after: &[Vector3<f64>],
    recording: &Recording,
) -> Option<Vec<Panel>> {
    let before = Correction::of(&holds.before.sensor)?;
    let gravity = holds.gravity.magnitude_mps2;
    let before: Vec<f64> = recording.readings().iter().map(|reading| before.apply(reading).norm()).collect();
    let after: Vec<f64> = after.iter().map(Vector3::norm).collect();
    let before = |k: usize| (recording.times_s()[k], before[k]);
    let after = |k: usize| (recording.times_s()[k], after[k]);
    let line = |label: &str, colour, of: &dyn Fn(usize) -> (f64, f64)| {
        Series::stroke(label, colour, (0.9, ""), thinned((0..recording.len()).map(of)))
    };
    let (first, last) = (*recording.times_s().first()?, *recording.times_s().last()?);
    let at_gravity =
        Series::stroke("g", colour::BLACK, (1.2, "7 4"), vec![(first, gravity), (last, gravity)]);
    Some(vec![
        Panel::new("specific force", "time (s)", "|f| (m/s²)")
            .with(line(BEFORE, colour::ORANGE, &before))
            .with(line(AFTER, colour::BLUE, &after))
            .with(at_gravity.clone()),
        Panel::new("specific force in holds", "time (s)", "|f| (m/s²)")
            .with(ranges("before, in a hold", colour::ORANGE, 5.5, holds, before))
            .with(ranges("after, in a hold", colour::BLUE, 2.5, holds, after))
            .with(at_gravity),
    ])
}

/// The smallest and the largest value in each hold, as a bar at its middle. `sample`: time and value of a sample.
fn ranges(
    label: &str,
    colour: &'static str,
    width: f64,
    holds: &HoldCalibration,
    sample: impl Fn(usize) -> (f64, f64),
) -> Series {
    let ends = holds.holds.iter().map(|result| {
        let values = (result.hold.first..result.hold.end).map(&sample).map(|(_, value)| value);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let middle_s = 0.5 * (result.hold.start_s + result.hold.end_s);
        ((middle_s, 0.5 * (low + high)), 0.5 * (high - low))
    });
    let (points, spread) = ends.unzip();
    Series { spread, ..Series::new(label, colour, Mark::Ranges { width }, points) }
}

/// The rate after the correction, and the change by it. `after` are the corrected readings.
fn rate_panels(before: &Uncalibrated, after: &[Vector3<f64>], recording: &Recording) -> Option<Vec<Panel>> {
    let before = Correction::of(&before.sensor)?;
    let after = || recording.times_s().iter().copied().zip(after);
    let magnitude = thinned(after().map(|(t, rate)| (t, rate.norm().to_degrees())));
    let rate = Panel::new("angular rate, after", "time (s)", "|ω| (°/s)").with(Series::stroke(
        AFTER,
        colour::BLUE,
        (0.9, ""),
        magnitude,
    ));
    let mut change = Panel::new("change by the correction", "time (s)", "ω after − before (°/s)");
    let looks = [(colour::VERMILLION, ""), (colour::GREEN, "6 3"), (colour::BLUE, "2 2")];
    for (axis, (colour, dashes)) in Axis::ALL.into_iter().zip(looks) {
        let row = before.matrix.row(axis.index()).transpose();
        let difference = thinned(after().zip(recording.readings()).map(|((t, after), reading)| {
            (t, (after[axis.index()] - row.dot(&(reading - before.bias))).to_degrees())
        }));
        let label = format!("change of axis {axis}");
        change = change.with(Series::stroke(&label, colour, (1.1, dashes), difference));
    }
    Some(vec![rate, change])
}
