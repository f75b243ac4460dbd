//! Figures of the gyroscope in the holds: its mean rate at rest, and its bias over temperature.

use super::panel::{Panel, Series};
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, HoldCalibration, HoldResult};
use calibrant_core::sensor::{Axis, Correction, Recording, SensorKind};
use nalgebra::Vector3;

/// Below this rate in °/s, rates are given in °/h.
const SLOW_DEGPS: f64 = 0.02;
/// Number of points of the fitted polynomial.
const POINTS: usize = 60;
const HOLD: [&str; 2] = ["hold", "hold, not used"];

struct Still {
    time_s: f64,
    temperature_c: Option<f64>,
    /// Its mean reading less its response to gravity.
    reading: Vector3<f64>,
    samples: f64,
    used: bool,
}

/// The holds that have readings of the gyroscope.
fn still(calibration: &Calibration, holds: &HoldCalibration, gyroscope: &Recording) -> Vec<Still> {
    let of = |(j, hold): (usize, &HoldResult)| {
        let still = gyroscope.mean_between(hold.hold.start_s, hold.hold.end_s)?;
        Some(Still {
            time_s: 0.5 * (hold.hold.start_s + hold.hold.end_s),
            temperature_c: holds.temperatures_c.as_ref().map(|temperatures| temperatures[j]),
            reading: still.mean - calibration.imu.g_sensitivity * hold.force_mps2,
            samples: still.samples as f64,
            used: hold.used,
        })
    };
    holds.holds.iter().enumerate().filter_map(of).collect()
}

/// A reading over the gain of its axis, in degrees.
fn degrees(calibration: &Calibration, axis: Axis, reading: f64) -> f64 {
    let k = axis.index();
    (reading / calibration.imu[SensorKind::Gyroscope].matrix.row(k).norm()).to_degrees()
}

/// The mean rate of the corrected gyroscope in each hold. It should be zero. Beside it is what noise and
/// scatter explain. `None` where no hold has readings of the gyroscope.
pub(crate) fn still_gyroscope(
    calibration: &Calibration,
    holds: &HoldCalibration,
    gyroscope: &Recording,
) -> Option<Figure> {
    let at_rest = &calibration.gyroscope.as_ref()?.still;
    let rate = |still: Still| {
        let imu = still.temperature_c.map_or(calibration.imu, |temperature| calibration.imu.at(temperature));
        let rate = Correction::of(&imu[SensorKind::Gyroscope])?.apply(&still.reading).map(f64::to_degrees);
        Some((still, rate))
    };
    let means: Vec<(Still, Vector3<f64>)> =
        still(calibration, holds, gyroscope).into_iter().filter_map(rate).collect();
    let largest =
        means.iter().map(|(_, rate)| rate.amax()).filter(|rate| rate.is_finite()).fold(0.0, f64::max);
    let (factor, label) =
        if largest < SLOW_DEGPS { (3600.0, "rate shown (°/h)") } else { (1.0, "rate shown (°/s)") };
    let panels = Panel::by_axis(&Axis::ALL, "time (s)", label, |axis, panel| {
        let k = axis.index();
        let noise = |of: &Still| degrees(calibration, axis, at_rest.noise[k]) / of.samples.sqrt();
        let between = degrees(calibration, axis, at_rest.between_holds_sd[k]);
        let twice = |sd: &dyn Fn(&Still) -> f64| means.iter().map(|(of, _)| 2.0 * factor * sd(of)).collect();
        let zeros = means.iter().map(|(of, _)| (of.time_s, 0.0)).collect();
        let at = || means.iter().map(|(of, rate)| (of.used, (of.time_s, factor * rate[k])));
        let all = at().map(|(_, point)| point).collect();
        panel
            .with(Series::band("±2 sd expected", colour::SKY, zeros, twice(&|of| noise(of).hypot(between))))
            .with(Series::bars("±2 sd of noise alone", colour::GREY, all, twice(&noise)))
            .with_used(HOLD, [2.8, 4.5], at())
    });
    let caption = "Mean of the corrected gyroscope in each hold, which should be zero. Good: no trend, and nineteen in twenty within the band. If the bars are far shorter \
                   than the band, the bias wanders from hold to hold by more than noise explains (temperature, supply, the Earth's rate of 15 °/h). \
                   Longer holds will not determine it better. The stated standard deviations include the wander.";
    Some(Figure::new("The gyroscope at rest", panels, caption))
}

/// Mean of the gyroscope's readings in each hold over its temperature, less its response to gravity, and the
/// fitted polynomial. `None` where nothing follows temperature.
pub(crate) fn bias_over_temperature(
    calibration: &Calibration,
    holds: &HoldCalibration,
    gyroscope: &Recording,
) -> Option<Figure> {
    let at_rest = &calibration.gyroscope.as_ref()?.still;
    holds.temperatures_c.as_ref()?;
    let imu = &calibration.imu;
    let [low, high] = imu.thermal.range_c?;
    let means = still(calibration, holds, gyroscope);
    let label = "bias less that at T₀ (°/s)";
    let panels = Panel::by_axis(&Axis::ALL, "temperature (°C)", label, |axis, panel| {
        let k = axis.index();
        // relative to the bias at the reference, so that counts and rates look alike
        let degps = |reading: f64| degrees(calibration, axis, reading - imu[SensorKind::Gyroscope].bias[k]);
        let twice = |of: &Still| {
            let noise = at_rest.noise[k] / of.samples.sqrt();
            2.0 * degrees(calibration, axis, noise.hypot(at_rest.between_holds_sd[k]))
        };
        let at = || means.iter().filter_map(|of| Some((of.used, (of.temperature_c?, degps(of.reading[k])))));
        let all = at().map(|(_, point)| point).collect();
        let temperature = |i: usize| low + (high - low) * i as f64 / POINTS as f64;
        let fitted = (0..=POINTS)
            .map(temperature)
            .map(|t| (t, degps(imu.at(t)[SensorKind::Gyroscope].bias[k])))
            .collect();
        panel
            .with(Series::bars("±2 sd", colour::GREY, all, means.iter().map(twice).collect()))
            .with(Series::line("polynomial", colour::SKY, fitted))
            .with_used(HOLD, [2.8, 4.5], at())
    });
    let caption = "Mean of the gyroscope in each hold over its temperature, and the fitted polynomial. Good: nineteen bars in twenty touch the line, \
                   and the line follows every bend. If neighbouring bars miss the line together, raise the order. Beyond the holds the line is an extrapolation.";
    Some(Figure::new("The gyroscope's bias over temperature", panels, caption))
}
