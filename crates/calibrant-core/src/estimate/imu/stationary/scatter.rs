//! The scatter of the gyroscope's samples in the stationary intervals.

use crate::estimate::holds::median;
use crate::motion::Hold;
use crate::sensor::{MeanReading, Recording};
use nalgebra::Vector3;

/// The gyroscope's samples in a hold. `None` for fewer than two.
pub(crate) fn mean_in_hold(recording: &Recording, hold: &Hold) -> Option<MeanReading> {
    recording.mean_between(hold.start_s, hold.end_s).filter(|still| still.samples > 1)
}

/// Standard deviation of a sample about the mean of its hold, without holds in which the gyroscope turns.
pub(crate) fn usual_scatter(readings: &[Option<MeanReading>], gyroscope: &Recording) -> Vector3<f64> {
    let sds: Vec<Vector3<f64>> =
        readings.iter().flatten().map(|still| MeanReading::pooled_sd([still])).collect();
    if sds.is_empty() {
        return Vector3::zeros();
    }
    let restless = restless_from(&sds, gyroscope);
    let calm =
        readings.iter().flatten().zip(&sds).filter(|(_, sd)| (0..3).all(|axis| sd[axis] <= restless[axis]));
    MeanReading::pooled_sd(calm.map(|(still, _)| still))
}

/// The gyroscope turns in a hold if it scatters there by this multiple of the median hold.
const RESTLESS: f64 = 4.0;

/// Least standard deviation of the samples of a hold in which the gyroscope turns, from those of all holds (at least one).
///
/// Coarse steps scatter by themselves, and are allowed for.
pub(crate) fn restless_from(sds: &[Vector3<f64>], gyroscope: &Recording) -> Vector3<f64> {
    let step = gyroscope.resolution();
    Vector3::from_fn(|axis, _| RESTLESS * median(sds.iter().map(|sd| sd[axis]).collect()).max(step[axis]))
}
