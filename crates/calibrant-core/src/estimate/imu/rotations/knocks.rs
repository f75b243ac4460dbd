//! Knocks within a rotation: pulses as short as a few sample steps, whose integral the samples show only roughly.
//!
//! A knock where the sensor is set down is real motion, and its samples belong to the rotation. Their error grows with what the pulse contains
//! beyond the rate of the samples. The fourth difference of the samples is a measure of it: the error's standard deviation is a multiple of it,
//! the knock factor, which depends on the sensor's filter.

use nalgebra::{Matrix3, Vector3};

/// A knock has a fourth difference this many times as large as all but a tenth of those of the rotation.
const STANDS_OUT: f64 = 5.0;

/// Five samples have no fourth difference where one between them is missing: their time is this many usual steps at least.
const WITH_A_GAP: f64 = 4.5;

/// `Σ h² d dᵀ` of the fourth differences `d` that stand out, with the sample step `h`.
pub(crate) fn sampled_knocks(times_s: &[f64], readings: &[Vector3<f64>]) -> Matrix3<f64> {
    covariance(times_s, readings).unwrap_or_else(Matrix3::zeros)
}

fn covariance(times_s: &[f64], readings: &[Vector3<f64>]) -> Option<Matrix3<f64>> {
    let span = |[from, .., to]: &[f64; 5]| to - from;
    let usual_s = quantile(times_s.array_windows().map(span).collect(), 0.5)?;
    let step_s = 0.25 * usual_s;
    let fourth = |[a, b, c, d, e]: &[Vector3<f64>; 5]| (a + e - (b + d) * 4.0 + c * 6.0) / 16.0;
    let is_whole = |times: &[f64; 5]| span(times) < WITH_A_GAP * step_s;
    let windows = times_s.array_windows().zip(readings.array_windows());
    let differences: Vec<Vector3<f64>> =
        windows.filter(|(times, _)| is_whole(times)).map(|(_, readings)| fourth(readings)).collect();
    let least = STANDS_OUT * quantile(differences.iter().map(Vector3::norm).collect(), 0.9)?;
    let knocks = differences.iter().filter(|difference| difference.norm() > least);
    Some(knocks.map(|difference| difference * difference.transpose()).sum::<Matrix3<f64>>() * step_s.powi(2))
}

/// The value that this share of all is below; `None` of none.
fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    let place = (share * values.len() as f64) as usize;
    (place < values.len()).then(|| *values.select_nth_unstable_by(place, f64::total_cmp).1)
}
