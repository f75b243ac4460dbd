//! The specific force at the gyroscope's samples, which acts through the g-sensitivity.

use crate::sensor::{Correction, Recording, SensorParameters, interpolated};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Number of samples of one piece of work of a thread.
const PIECE: usize = 4096;

/// The specific force at the gyroscope's sample times.
pub(crate) fn interpolated_forces(
    accelerometer: &Recording,
    gyroscope: &Recording,
    sensor: &SensorParameters,
) -> Option<Vec<Vector3<f64>>> {
    let correction = Correction::of(sensor)?;
    let force = |k: usize| correction.apply(&accelerometer.readings[k]);
    let at = |k: usize| interpolated(&accelerometer.times_s, force, gyroscope.times_s[k], k);
    // zero only for an accelerometer without samples
    let felt = |k: usize| at(k).unwrap_or_else(Vector3::zeros);
    Some((0..gyroscope.len()).into_par_iter().with_min_len(PIECE).map(felt).collect())
}
