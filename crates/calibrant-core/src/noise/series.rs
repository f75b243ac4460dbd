//! The readings of one axis at equal intervals, and what several estimates need of them.

use super::steps::Steps;

/// The readings, with what is computed from them once.
pub(super) struct Series {
    pub(super) values: Vec<f64>,
    pub(super) mean: f64,
    /// Sum of the squares of the deviations from the mean.
    pub(super) square: f64,
    /// The [phase].
    pub(super) phase: Vec<f64>,
    pub(super) steps: Steps,
}

impl Series {
    pub(super) fn of(values: Vec<f64>) -> Self {
        let mean = mean(&values);
        let square = values.iter().map(|y| (y - mean).powi(2)).sum();
        Self { mean, square, phase: phase(&values, mean), steps: Steps::of(&values), values }
    }

    /// Standard deviation of the values about their mean.
    pub(super) fn sd(&self) -> f64 {
        (self.square / (self.values.len() as f64 - 1.0)).sqrt()
    }
}

/// Running sums of the readings less their mean, from zero on: the phase `x`. Subtracting the mean saves the
/// digits that it would take.
pub(super) fn phase(readings: &[f64], mean: f64) -> Vec<f64> {
    let mut phase = Vec::with_capacity(readings.len() + 1);
    let mut sum = 0.0;
    phase.push(sum);
    for reading in readings {
        sum += reading - mean;
        phase.push(sum);
    }
    phase
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
