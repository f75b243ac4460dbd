//! Figures of a rehearsal: plain routine against best trajectory, sensor by sensor, as the thesis's Figures 10 and 11.

use super::Figure;
use super::design_population::named;
use super::panel::{Panel, Points};
use super::point_thinning::{drawn_in_words, every};
use super::unit::DisplayUnit;
use calibrant_study::{Rehearsal, RehearsedCalibration, RehearsedSensor};

/// Largest number of sensors that are drawn one by one.
const MOST_SENSORS: usize = 200;

/// A number of each of these sensors by its number, with both motions.
fn both(
    study: &Rehearsal,
    shown: &[usize],
    of: impl Fn(&RehearsedSensor, &RehearsedCalibration) -> f64,
) -> [Points; 2] {
    let points = |pick: fn(&RehearsedSensor) -> &RehearsedCalibration| {
        let point = |&i: &usize| ((i + 1) as f64, of(&study.sensors[i], pick(&study.sensors[i])));
        shown.iter().map(point).filter(|(_, y)| y.is_finite()).collect()
    };
    [points(|sensor| &sensor.plain), points(|sensor| &sensor.optimal)]
}

/// Standard deviations that the calibrations state, in parts of those that were designed for the best trajectory: their geometric mean.
pub(crate) fn rehearsed_sds(study: &Rehearsal) -> Figure {
    let shown = every(study.sensors.len(), MOST_SENSORS);
    let [_, designed] = &study.designed_sd;
    let mean = |_: &RehearsedSensor, by: &RehearsedCalibration| {
        let logs: f64 = by.sd.iter().zip(designed).map(|(sd, designed)| (sd / designed).ln()).sum();
        (logs / designed.len() as f64).exp()
    };
    let panel = Panel::new("", "sensor", "sd / designed sd");
    let panel = named(panel, study.routine, both(study, &shown, mean), |y| y).log_or_from_zero(false);
    let caption = "What each calibration states: the geometric mean over the parameters of its standard deviations, each in parts of what the design promised for the best \
         trajectory. Squares at 1 keep the promise.";
    let caption = caption.to_owned() + &drawn_in_words(study.sensors.len(), shown.len());
    Figure::new("Stated standard deviations, sensor by sensor", vec![panel], caption)
}

/// Absolute errors of each parameter, with both motions.
pub(crate) fn rehearsed_errors(study: &Rehearsal) -> Figure {
    let shown = every(study.sensors.len(), MOST_SENSORS);
    let panel = |(p, parameter): (usize, &calibrant_core::sensor::Parameter)| {
        let pair = both(study, &shown, |of, by| (by.values[p] - of.truth[p]).abs());
        let largest = pair.iter().flatten().map(|(_, y)| *y);
        let unit = DisplayUnit::suited_to(parameter.unit, largest);
        let panel = Panel::new(parameter.name.clone(), "sensor", unit.label("|error|"));
        named(panel, study.routine, pair, |error| error * unit.factor).log_or_from_zero(false)
    };
    let panels = study.parameters.iter().enumerate().map(panel).collect();
    let caption = "Distance of each estimate from the truth. Single sensors may be lucky with a poor motion."
        .to_owned();
    let caption = caption + &drawn_in_words(study.sensors.len(), shown.len());
    Figure::new("Absolute errors", panels, caption).with_columns(3)
}
