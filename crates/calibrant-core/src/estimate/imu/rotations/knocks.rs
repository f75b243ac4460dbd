//! Knocks within a rotation: pulses as short as a few sample steps, whose integral the samples show only roughly.
//!
//! A knock where the sensor is set down is real motion, and its samples belong to the rotation. Their error grows with what the pulse contains
//! beyond the rate of the samples. The fourth difference of the samples is a measure of it: the error's standard deviation is a multiple of it,
//! the knock factor, which depends on the sensor's filter.

use crate::sensor::quantile;
use nalgebra::{Matrix3, Vector3};

/// A knock has a fourth difference this many times as large as all but a tenth of those of the rotation.
const STANDS_OUT: f64 = 5.0;

/// Five samples have no fourth difference where one between them is missing: their time is this many usual steps at least.
const WITH_A_GAP: f64 = 4.5;

/// The knocks of a rotation.
#[derive(Debug, Clone, Default)]
pub(crate) struct Knocks {
    /// `Σ h² d dᵀ` of the fourth differences `d` at knocks with the sample step `h`, in the unit of the readings times s, squared.
    pub(crate) covariance: Matrix3<f64>,
    /// Their times, s.
    pub(crate) times_s: Vec<f64>,
}

impl Knocks {
    /// The fourth differences that stand out.
    pub(crate) fn find(times_s: &[f64], readings: &[Vector3<f64>]) -> Self {
        Self::search(times_s, readings).unwrap_or_default()
    }

    fn search(times_s: &[f64], readings: &[Vector3<f64>]) -> Option<Self> {
        let span = |[from, .., to]: &[f64; 5]| to - from;
        let step_s = 0.25 * quantile(times_s.array_windows().map(span).collect(), 0.5)?;
        let fourth = |[a, b, c, d, e]: &[Vector3<f64>; 5]| (a + e - (b + d) * 4.0 + c * 6.0) / 16.0;
        let is_whole = |times: &[f64; 5]| span(times) < WITH_A_GAP * step_s;
        let windows = times_s.array_windows().zip(readings.array_windows());
        let whole = windows.filter(|(times, _)| is_whole(times));
        let differences: Vec<(f64, Vector3<f64>)> =
            whole.map(|(times, readings)| (times[2], fourth(readings))).collect();
        let least = STANDS_OUT * quantile(differences.iter().map(|(_, d)| d.norm()).collect(), 0.9)?;
        let mut knocks = Self::default();
        for (time_s, difference) in differences.iter().filter(|(_, difference)| difference.norm() > least) {
            knocks.covariance += difference * difference.transpose() * step_s.powi(2);
            knocks.times_s.push(*time_s);
        }
        Some(knocks)
    }
}
