//! How far holds are from gravity, all together.

use crate::estimate::HoldResult;

/// Root mean square of `|f| − g` over the holds that are used, m/s².
pub(in crate::estimate) fn magnitude_rms(holds: &[HoldResult]) -> f64 {
    let squares: Vec<f64> =
        holds.iter().filter(|hold| hold.used).map(|hold| hold.magnitude_residual_mps2.powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}
