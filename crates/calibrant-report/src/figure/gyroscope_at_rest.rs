//! The figure of the gyroscope's mean rate at rest.

use super::panel::{Mark, Panel, Series, Shape};
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, HoldCalibration};
use calibrant_core::sensor::{Axis, Correction, Recording};
use nalgebra::Vector3;

/// Below this rate in °/s, rates are given in °/h.
const SLOW_DEGPS: f64 = 0.02;

/// The mean rate of the corrected gyroscope in each hold. It should be zero. Beside it is what noise and
/// scatter explain. `None` where no hold has readings of the gyroscope.
pub(crate) fn still_gyroscope(
    calibration: &Calibration,
    holds: &HoldCalibration,
    gyroscope: &Recording,
) -> Option<Figure> {
    let at_rest = &calibration.gyroscope.as_ref()?.still;
    let means: Vec<Mean> = holds
        .holds
        .iter()
        .enumerate()
        .filter_map(|(j, hold)| {
            let still = gyroscope.mean_between(hold.hold.start_s, hold.hold.end_s)?;
            let temperature_c = holds.temperatures_c.as_ref().map(|temperatures| temperatures[j]);
            let imu = temperature_c.map_or(calibration.imu, |temperature| calibration.imu.at(temperature));
            let correction = Correction::of(&imu.gyroscope)?;
            let felt = calibration.imu.g_sensitivity * hold.force_mps2;
            Some(Mean {
                time_s: 0.5 * (hold.hold.start_s + hold.hold.end_s),
                rate_degps: correction.apply(&(still.mean - felt)).map(f64::to_degrees),
                samples: still.samples,
                used: hold.used,
            })
        })
        .collect();
    let gain = Vector3::from_fn(|axis, _| calibration.imu.gyroscope.matrix.row(axis).norm());
    let degps = |sd: &Vector3<f64>, axis: usize| (sd[axis] / gain[axis]).to_degrees();
    let largest =
        means.iter().map(|mean| mean.rate_degps.amax()).filter(|rate| rate.is_finite()).fold(0.0, f64::max);
    let (factor, label) =
        if largest < SLOW_DEGPS { (3600.0, "rate shown (°/h)") } else { (1.0, "rate shown (°/s)") };
    let panels = Axis::ALL
        .iter()
        .map(|axis| {
            let k = axis.index();
            let noise = |mean: &Mean| degps(&at_rest.noise, k) / (mean.samples as f64).sqrt();
            let between = degps(&at_rest.between_holds_sd, k);
            let twice =
                |sd: &dyn Fn(&Mean) -> f64| means.iter().map(|mean| 2.0 * factor * sd(mean)).collect();
            let at = |used: Option<bool>| -> Vec<(f64, f64)> {
                let chosen = means.iter().filter(|mean| used.is_none_or(|used| mean.used == used));
                chosen.map(|mean| (mean.time_s, factor * mean.rate_degps[k])).collect()
            };
            let zeros = means.iter().map(|mean| (mean.time_s, 0.0)).collect();
            let mut panel = Panel::new(format!("axis {axis}"), "time (s)", label)
                .with(
                    Series::new("±2 sd expected", colour::SKY, Mark::Band, zeros)
                        .with_spread(twice(&|mean| noise(mean).hypot(between))),
                )
                .with(
                    Series::new("±2 sd of noise alone", colour::GREY, Mark::ErrorBars, at(None))
                        .with_spread(twice(&noise)),
                )
                .with(Series::new(
                    "hold",
                    colour::BLUE,
                    Mark::Dots { shape: Shape::Circle, radius: 2.8 },
                    at(Some(true)),
                ));
            let left_out = at(Some(false));
            if !left_out.is_empty() {
                let mark = Mark::Dots { shape: Shape::Cross, radius: 4.5 };
                panel = panel.with(Series::new("hold, left out", colour::VERMILLION, mark, left_out));
            }
            panel
        })
        .collect();
    let caption = "Mean of the corrected gyroscope in each hold, which should be zero. Good: no trend, and nineteen in twenty within the band. If the bars are far shorter \
                   than the band, the bias wanders from hold to hold by more than noise explains (temperature, supply, the Earth's rate of 15 °/h). \
                   Longer holds will not determine it better. The stated standard deviations include the wander.";
    Some(Figure::new("The gyroscope at rest", panels, caption))
}

/// The gyroscope in a hold.
struct Mean {
    time_s: f64,
    rate_degps: Vector3<f64>,
    samples: usize,
    used: bool,
}
