//! Holds in which the gyroscope turns: the accelerometer does not see a turn about the vertical.
//!
//! Holds that are found are still for both sensors, those that are given may not be. What the gyroscope shows in such a hold is no bias; the accelerometer's mean may be right.

use crate::estimate::holds::median;
use crate::motion::Hold;
use crate::sensor::{Axis, MeanReading, Recording};
use nalgebra::Vector3;

/// The gyroscope turns in a hold whose mean is off the median of all by so many median deviations …
const DEVIATIONS: f64 = 12.0;
/// … and by this share of the recording's range: a bias that drifts is not.
const TURNING: f64 = 0.005;
/// It turns, too, in a hold in which it scatters so many times as much as in half of the holds.
const RESTLESS: f64 = 4.0;
/// Fewer holds do not tell which of them is the exception.
const FEWEST: usize = 4;

/// From which standard deviation of its samples on the gyroscope turns in a hold, by those in all of them, at least one; coarse steps scatter by themselves.
pub(super) fn restless_from(sds: &[Vector3<f64>], gyroscope: &Recording) -> Vector3<f64> {
    let step = gyroscope.resolution();
    Vector3::from_fn(|axis, _| RESTLESS * median(sds.iter().map(|sd| sd[axis]).collect()).max(step[axis]))
}

/// Takes out what the gyroscope shows in the holds in which it turns, and says so for each. `numbers`: those of the holds, from 0; `drifts`: does its bias follow temperature?
pub(super) fn take_out(
    stills: &mut [Option<MeanReading>],
    (holds, numbers): (&[&Hold], &[usize]),
    gyroscope: &Recording,
    drifts: bool,
) -> Vec<String> {
    if stills.iter().flatten().count() < FEWEST {
        return Vec::new();
    }
    let scatter: Vec<Option<Vector3<f64>>> =
        stills.iter().map(|still| still.as_ref().map(|still| MeanReading::pooled_sd([still]))).collect();
    let mut turning = vec![None; stills.len()];
    let sds: Vec<Vector3<f64>> = scatter.iter().flatten().copied().collect();
    let restless = restless_from(&sds, gyroscope);
    let [low, high] = gyroscope.extremes();
    let least = if drifts { f64::INFINITY } else { TURNING * (high - low).amax() };
    for axis in Axis::ALL {
        let axis = axis.index();
        let middle = median(stills.iter().flatten().map(|still| still.mean[axis]).collect());
        let deviation =
            median(stills.iter().flatten().map(|still| (still.mean[axis] - middle).abs()).collect());
        for (j, (still, sd)) in stills.iter().zip(&scatter).enumerate() {
            let (Some(still), Some(sd)) = (still, sd) else { continue };
            let off = still.mean[axis] - middle;
            if off.abs() > (DEVIATIONS * deviation).max(least) || sd[axis] > restless[axis] {
                let rate = off.hypot(sd[axis]);
                let most = turning[j].map_or(rate, |most: f64| most.max(rate));
                turning[j] = Some(most);
            }
        }
    }
    // where most holds are restless, none is an exception
    if 2 * turning.iter().flatten().count() >= stills.iter().flatten().count() {
        return Vec::new();
    }
    let mut said = Vec::new();
    for (j, rate) in turning.iter().enumerate() {
        let Some(rate) = rate else { continue };
        stills[j] = None;
        said.push(format!(
            "the gyroscope turns in {}, by {rate:.2e} {} rms: what it shows there is not taken for its bias; an accelerometer does not see a turn \
             about the vertical: correct holds.intervals_s, or leave them away so that holds are looked for",
            holds[j].named(numbers[j]),
            gyroscope.unit.symbol()
        ));
    }
    said
}
