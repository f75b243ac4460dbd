//! Spikes in the movements of a gyroscope, or knocks: the rotations decide.
//!
//! A spike that is cut out of a rotation makes its integral right, a knock that is cut makes it wrong.

use crate::diagnostic::samples::KnocksKept;
use crate::estimate::result::Calibration;

impl KnocksKept {
    /// Compares a calibration without these samples with one that keeps them. `None` where the rotations are no better with them.
    #[must_use]
    pub fn of(cut: Option<&Calibration>, kept: &Calibration, samples: usize) -> Option<Self> {
        let (cut_rad, kept_rad) = (cut.map_or(f64::INFINITY, error_rad), error_rad(kept));
        (kept_rad < cut_rad).then_some(Self { samples, kept_rad, cut_rad })
    }
}

/// Root mean square of the errors of all rotations, also of those that are not used.
fn error_rad(calibration: &Calibration) -> f64 {
    let rotations = calibration.rotations().iter().filter(|rotation| rotation.is_integrated());
    let squares: Vec<f64> = rotations.map(|rotation| rotation.error_rad.powi(2)).collect();
    if squares.is_empty() {
        f64::INFINITY
    } else {
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }
}
