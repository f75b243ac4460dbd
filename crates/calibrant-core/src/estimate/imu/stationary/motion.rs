//! Motion in holds: the accelerometer does not see a turn about the vertical.
//!
//! In detected holds, both sensors are stationary. In given holds, the gyroscope may turn. Its mean there is not its bias, but the accelerometer's
//! mean may be right.

use crate::estimate::holds::median;
use crate::estimate::imu::stationary::scatter::restless_from;
use crate::sensor::{Axis, MeanReading, Recording};
use nalgebra::Vector3;

/// Least distance of a turning hold's mean from the median of all holds, in median deviations. [`TURNING_SHARE`] must be exceeded too.
const DEVIATIONS: f64 = 12.0;

/// Least distance of a turning hold's mean, as a share of the recording's range. A drift of the bias stays below.
const TURNING_SHARE: f64 = 0.002;

/// Fewest holds in which an exception can be found.
const FEWEST: usize = 4;

/// The rate, root mean square, of each hold in which the gyroscope turns, in the unit of its readings. `drifts`: does its bias follow temperature?
pub(crate) fn turning_rates(
    readings: &[Option<MeanReading>],
    gyroscope: &Recording,
    drifts: bool,
) -> Vec<Option<f64>> {
    let none = vec![None; readings.len()];
    if readings.iter().flatten().count() < FEWEST {
        return none;
    }
    let scatter: Vec<Option<Vector3<f64>>> =
        readings.iter().map(|still| still.as_ref().map(|still| MeanReading::pooled_sd([still]))).collect();
    let mut turning = none.clone();
    let sds: Vec<Vector3<f64>> = scatter.iter().flatten().copied().collect();
    let restless = restless_from(&sds, gyroscope);
    let [low, high] = gyroscope.extremes();
    let least = if drifts { f64::INFINITY } else { TURNING_SHARE * (high - low).amax() };
    for axis in Axis::ALL {
        let axis = axis.index();
        let middle = median(readings.iter().flatten().map(|still| still.mean[axis]).collect());
        let deviation =
            median(readings.iter().flatten().map(|still| (still.mean[axis] - middle).abs()).collect());
        for (j, (still, sd)) in readings.iter().zip(&scatter).enumerate() {
            let (Some(still), Some(sd)) = (still, sd) else { continue };
            let off = still.mean[axis] - middle;
            if off.abs() > (DEVIATIONS * deviation).max(least) || sd[axis] > restless[axis] {
                let rate = off.hypot(sd[axis]);
                let most = turning[j].map_or(rate, |most: f64| most.max(rate));
                turning[j] = Some(most);
            }
        }
    }
    // if most holds are restless, none is an exception
    if 2 * turning.iter().flatten().count() >= readings.iter().flatten().count() { none } else { turning }
}
