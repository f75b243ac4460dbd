//! The figure of the gyroscope's bias over temperature.

use super::panel::{Mark, Panel, Series, Shape};
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, HoldCalibration};
use calibrant_core::sensor::{Axis, Recording};
use nalgebra::Vector3;

/// Number of points of the fitted polynomial.
const POINTS: usize = 60;

/// Mean of the gyroscope's readings in each hold over its temperature, less its response to gravity, and the
/// fitted polynomial. `None` where nothing follows temperature.
pub(crate) fn bias_over_temperature(
    calibration: &Calibration,
    holds: &HoldCalibration,
    gyroscope: &Recording,
) -> Option<Figure> {
    let at_rest = &calibration.gyroscope.as_ref()?.still;
    let temperatures = holds.temperatures_c.as_ref()?;
    let [low, high] = calibration.imu.thermal.range_c?;
    let imu = &calibration.imu;
    let means: Vec<(f64, Vector3<f64>, usize, bool)> = holds
        .holds
        .iter()
        .zip(temperatures)
        .filter_map(|(hold, &temperature)| {
            let still = gyroscope.mean_between(hold.hold.start_s, hold.hold.end_s)?;
            Some((temperature, still.mean - imu.g_sensitivity * hold.force_mps2, still.samples, hold.used))
        })
        .collect();
    let gain = Vector3::from_fn(|axis, _| imu.gyroscope.matrix.row(axis).norm());
    let panels = Axis::ALL
        .iter()
        .map(|axis| {
            let k = axis.index();
            // relative to the bias at the reference, so that counts and rates look alike
            let degps = |reading: f64| ((reading - imu.gyroscope.bias[k]) / gain[k]).to_degrees();
            let twice = |samples: usize| {
                let noise = at_rest.noise[k] / (samples as f64).sqrt();
                (2.0 * noise.hypot(at_rest.between_holds_sd[k]) / gain[k]).to_degrees()
            };
            let at = |used: bool| -> Vec<(f64, f64)> {
                let chosen = means.iter().filter(|hold| hold.3 == used);
                chosen.map(|(temperature, mean, ..)| (*temperature, degps(mean[k]))).collect()
            };
            let all = means.iter().map(|(temperature, mean, ..)| (*temperature, degps(mean[k]))).collect();
            let fitted = (0..=POINTS)
                .map(|i| {
                    let temperature = low + (high - low) * i as f64 / POINTS as f64;
                    (temperature, degps(imu.at(temperature).gyroscope.bias[k]))
                })
                .collect();
            let mark = |shape, radius| Mark::Dots { shape, radius };
            let mut panel =
                Panel::new(format!("axis {axis}"), "temperature (°C)", "bias less that at T₀ (°/s)")
                    .with(
                        Series::new("±2 sd", colour::GREY, Mark::ErrorBars, all)
                            .with_spread(means.iter().map(|hold| twice(hold.2)).collect()),
                    )
                    .with(Series::line("polynomial", colour::SKY, fitted))
                    .with(Series::new("hold", colour::BLUE, mark(Shape::Circle, 2.8), at(true)));
            let left_out = at(false);
            if !left_out.is_empty() {
                panel = panel.with(Series::new(
                    "hold, left out",
                    colour::VERMILLION,
                    mark(Shape::Cross, 4.5),
                    left_out,
                ));
            }
            panel
        })
        .collect();
    let caption = "Mean of the gyroscope in each hold over its temperature, and the fitted polynomial. Good: nineteen bars in twenty touch the line, \
                   and the line follows every bend. If neighbouring bars miss the line together, raise the order. Beyond the holds the line is an extrapolation.";
    Some(Figure::new("The gyroscope's bias over temperature", panels, caption))
}
