//! Scatter that the weights take up: of the rotations, of the gyroscope at rest, and gains that are hardly known.

use crate::diagnostic::gyroscope::{GainsUncertain, RestScatters, RotationsScatter, RotationsWorse};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::result::RotationResult;
use crate::sensor::{ImuQuantity, Quantity, SensorKind};

/// Excess of the rotation errors that no sound gyroscope has, rad: 0.5 % of a half turn, ten times its nonlinearity.
const SCATTERED_RAD: f64 = 0.01;
/// The same as a share of the path.
const SCATTERED_SHARE: f64 = 0.01;
/// Rotations are worse where their errors grow by this factor, and are larger than their noise by it: the least squares make those of one recording smaller.
const WORSE: f64 = 1.5;
/// Scatter of the mean rate between holds that no gyroscope at rest has within a session, rad/s: 0.1 °/s.
const AT_REST_RADPS: f64 = 1.75e-3;
/// A bias is known far worse than noise allows beyond this ratio of standard deviations.
const BEYOND_NOISE: f64 = 50.0;
/// Relative standard deviation of a gain that is that of a gyroscope as it is delivered.
const GAIN_SD: f64 = 0.02;

/// Rotation errors beyond noise and knocks.
pub(crate) fn of_rotations(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let excess_sd_rad = evidence.model.rotation_scatter.between_sd_rad;
    let used: Vec<_> = calibration.rotations().iter().filter(|rotation| rotation.used).collect();
    let path_rad = (used.iter().map(|rotation| rotation.path_rad.powi(2)).sum::<f64>()
        / used.len().max(1) as f64)
        .sqrt();
    let peak_radps = used.iter().map(|rotation| rotation.peak_radps).fold(0.0, f64::max);
    // an excess that is hidden in the noise is not told from it
    let is_far = excess_sd_rad > SCATTERED_RAD
        && excess_sd_rad > SCATTERED_SHARE * path_rad
        && excess_sd_rad > noise_rad(evidence);
    is_far.then(|| RotationsScatter { excess_sd_rad, peak_radps }.into()).into_iter().collect()
}

/// Standard deviation of the rotation errors from the gyroscope's noise alone, per axis, rad: root mean square over the rotations.
fn noise_rad(evidence: &Evidence<'_>) -> f64 {
    let rotations = evidence.model.rotations.iter().zip(&evidence.fit.residuals);
    let used = rotations.filter(|(data, _)| data.used && data.counts);
    let (sum, count) = used
        .filter_map(|(_, residual)| Some(0.5 * residual.as_ref()?.covariance.trace()))
        .fold((0.0, 0.0), |(sum, count), variance| (sum + variance, count + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

/// Rotations that meet gravity worse with the calibration than without it.
pub(crate) fn of_worse_rotations(evidence: &Evidence<'_>) -> Diagnostics {
    let used = || evidence.calibration.rotations().iter().filter(|rotation| rotation.used);
    let rms = |error: fn(&RotationResult) -> f64| {
        (used().map(|of| error(of).powi(2)).sum::<f64>() / used().count().max(1) as f64).sqrt()
    };
    let (after_rad, before_rad) = (rms(|of| of.error_rad), rms(|of| of.error_before_rad));
    let is_worse = after_rad > WORSE * before_rad && after_rad > WORSE * noise_rad(evidence);
    is_worse.then(|| RotationsWorse { after_rad, before_rad }.into()).into_iter().collect()
}

/// The gyroscope's mean rates in the holds.
pub(crate) fn at_rest(evidence: &Evidence<'_>) -> Diagnostics {
    let Some(gyroscope) = &evidence.calibration.gyroscope else { return Vec::new() };
    let matrix = &evidence.calibration.imu[SensorKind::Gyroscope].matrix;
    let means = evidence.gyroscope.readings.iter().flatten();
    let samples: usize = means.map(|mean| mean.samples).sum();
    let of_noise = evidence.model.gyroscope_noise.variance(samples.max(1));
    let beyond = |axis: usize| {
        let quantity = ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(crate::sensor::Axis::ALL[axis]));
        let place = evidence.calibration.quantities.iter().position(|other| *other == quantity);
        let sd = place.map_or(0.0, |place| evidence.calibration.covariance[(place, place)].sqrt());
        let between = gyroscope.still.between_holds_sd[axis] / matrix.row(axis).norm();
        (sd > BEYOND_NOISE * of_noise[axis].sqrt() && between > AT_REST_RADPS).then_some(between)
    };
    let worst = (0..3).filter_map(beyond).reduce(f64::max);
    let has_g_sensitivity = evidence.problem.gyroscope.g_sensitivity;
    worst
        .map(|between_sd_radps| RestScatters { between_sd_radps, has_g_sensitivity }.into())
        .into_iter()
        .collect()
}

/// Gains that are known no better than by the datasheet.
pub(crate) fn of_gains(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let relative = |(place, quantity): (usize, &ImuQuantity)| match quantity {
        ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(_)) => {
            Some(calibration.covariance[(place, place)].sqrt() / calibration.values[place].abs())
        }
        _ => None,
    };
    let relative_sd = calibration.quantities.iter().enumerate().filter_map(relative).fold(0.0, f64::max);
    let rate_sd = evidence.problem.setup.rate_sd;
    (relative_sd > GAIN_SD).then(|| GainsUncertain { relative_sd, rate_sd }.into()).into_iter().collect()
}
