//! Linear drift of the readings. It is no noise, but it looks like noise at long cluster times.

use super::{NoiseModel, PowerLaw};
use std::f64::consts::PI;

/// A drift is significant beyond this many standard deviations of the largest noise within its limits. Up to
/// 2 % of random walks exceed it where K is as large as shows, and fewer where K is smaller
/// (`tests/noise.rs`).
const SIGNIFICANT: f64 = 2.0;

/// The slope of a straight line through the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// Slope, in the unit of the readings per second.
    pub per_s: f64,
    /// Its standard deviation if the noise is as estimated.
    pub sd: f64,
    /// Its standard deviation if one of the processes is at the upper end of its interval, or at its limit.
    /// This is the largest over the processes.
    ///
    /// The drift was subtracted from the Allan deviation. A random walk that does not show there still has a
    /// slope of its own.
    pub most_sd: f64,
}

impl Drift {
    /// The least-squares slope of the readings at equal intervals, judged by the noise.
    ///
    /// Its variance over a duration `T` is `72 Q²/T⁴ + 12 N²/T³ + 9 B²/(π T²) + 6 K²/(5 T)`.
    #[must_use]
    pub fn of(readings: &[f64], interval_s: f64, noise: &NoiseModel) -> Self {
        let n = readings.len() as f64;
        let middle = 0.5 * (n - 1.0);
        let mean = readings.iter().sum::<f64>() / n;
        let moment: f64 = readings.iter().enumerate().map(|(k, y)| (k as f64 - middle) * (y - mean)).sum();
        let per_s = moment / (n * (n * n - 1.0) / 12.0) / interval_s;
        let t = n * interval_s;
        let variance = |squares: &[f64; 4]| {
            let square = |process: PowerLaw| squares[process as usize];
            72.0 * square(PowerLaw::Quantisation) / t.powi(4)
                + 12.0 * square(PowerLaw::White) / t.powi(3)
                + 9.0 * square(PowerLaw::Flicker) / (PI * t * t)
                + 1.2 * square(PowerLaw::RandomWalk) / t
        };
        let with_most_of = |process: PowerLaw| {
            let mut squares = noise.squares;
            let of = noise.coefficient(process);
            let most = of.estimate().map(|found| found.high).or(of.limit()).unwrap_or(0.0);
            squares[process as usize] = squares[process as usize].max(most * most);
            variance(&squares)
        };
        let most = PowerLaw::ALL.map(with_most_of).into_iter().fold(0.0, f64::max);
        Self { per_s, sd: variance(&noise.squares).sqrt(), most_sd: most.sqrt() }
    }

    /// Is it more than any noise within its limits explains?
    #[must_use]
    pub fn is_significant(&self) -> bool {
        self.per_s.abs() > SIGNIFICANT * self.most_sd
    }

    /// Its contribution to the Allan deviation at cluster time `τ`: `R τ/√2`.
    #[must_use]
    pub fn allan_deviation(&self, tau_s: f64) -> f64 {
        self.per_s.abs() * tau_s / std::f64::consts::SQRT_2
    }
}
