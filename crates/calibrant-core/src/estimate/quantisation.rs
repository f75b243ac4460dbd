//! Quantisation steps that are coarser than the noise. They give the mean of a hold an error, however long the hold is.
//!
//! With steps `q` and Gaussian noise `σ`, the mean of rounded readings has an error that depends on the place of the true value between two steps. Over all
//! places,
//!
//! ```text
//! V = q²/(2π²) Σ_k exp(−4π² k² σ²/q²)/k²
//! ```
//!
//! is its mean square (`widrow2008`). The error is `q/√12` rms without noise, a hundredth of a step for `σ = 0.4 q`, and negligible from `σ = q/2` on. More
//! samples do not reduce it.

use super::quantised_noise::{Counts, noise_in_steps};
use crate::diagnostic::samples::CoarseSteps;
use crate::motion::Hold;
use crate::sensor::{Axis, MeanReading, ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::ops::Range;

/// Number of terms of the series.
const TERMS: i32 = 100;
/// Scatter of readings, in steps, from which on the steps do not matter.
const FINE_STEPS: f64 = 3.0;
/// Number of examined samples in the middle of each hold.
const MIDDLE_SAMPLES: usize = 64;

/// An axis with coarse steps: they add to the error of the means of holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoarseAxis {
    /// The axis.
    pub axis: Axis,
    /// The step of the readings, in their unit.
    pub step: f64,
    /// Standard deviation of the noise before it was rounded; 0 where it is too small to be seen.
    pub noise: f64,
    /// Root mean square `√V` of the error of a hold's mean, in the unit of the readings.
    pub mean_sd: f64,
}

impl CoarseAxis {
    /// What the check found in this sensor.
    #[must_use]
    pub fn check(&self, sensor_kind: SensorKind, unit: ReadingUnit) -> CoarseSteps {
        let Self { axis, step, noise, mean_sd } = *self;
        CoarseSteps { sensor_kind, axis, unit, step, noise, mean_sd }
    }
}

/// The coarse axes of a recording, from its samples in holds: the error of their means exceeds a quarter of the noise.
#[must_use]
pub fn coarse_axes(recording: &Recording, holds: &[Range<usize>]) -> Vec<CoarseAxis> {
    let resolution = recording.resolution();
    let of = |&axis: &Axis| coarse(recording, holds, axis, resolution[axis.index()]);
    recording.active_axes().iter().filter_map(of).collect()
}

/// The coarse axes of a recording, between the times of holds, which may be those of another sensor.
#[must_use]
pub fn coarse_axes_in<'a>(
    recording: &Recording,
    holds: impl IntoIterator<Item = &'a Hold>,
) -> Vec<CoarseAxis> {
    let spans: Vec<_> = holds.into_iter().map(|hold| recording.between(hold.start_s, hold.end_s)).collect();
    coarse_axes(recording, &spans)
}

/// `V` of each axis, in the square of the unit of the readings.
pub(super) fn of_means(coarse: &[CoarseAxis]) -> Vector3<f64> {
    let mut variance = Vector3::zeros();
    for found in coarse {
        variance[found.axis.index()] = found.mean_sd * found.mean_sd;
    }
    variance
}

fn coarse(recording: &Recording, holds: &[Range<usize>], axis: Axis, step: f64) -> Option<CoarseAxis> {
    if step <= 0.0 {
        return None;
    }
    let longer = |hold: &&Range<usize>| hold.len() > 1;
    let middle = |hold: &Range<usize>| {
        let first = hold.start + hold.len().saturating_sub(MIDDLE_SAMPLES) / 2;
        MeanReading::of(&recording.readings[first..hold.end.min(first + MIDDLE_SAMPLES)])
    };
    let middles: Vec<MeanReading> = holds.iter().filter(longer).filter_map(middle).collect();
    // most readings are far finer, and need no further test
    if MeanReading::pooled_sd(&middles)[axis.index()] > FINE_STEPS * step {
        return None;
    }
    let (mut counts, mut samples, mut squares) = (Vec::new(), 0, 0.0);
    for hold in holds.iter().filter(longer) {
        let values: Vec<f64> = recording.readings[hold.clone()].iter().map(|y| y[axis.index()]).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        squares += values.iter().map(|y| (y - mean).powi(2)).sum::<f64>();
        samples += values.len() - 1;
        // the ends of a hold may already move
        let end = values.len() / 5;
        counts.push(Counts::of(&values[end..values.len() - end], step));
    }
    let scatter = (squares / samples.max(1) as f64).sqrt();
    // noise of a whole step leaves no error
    if samples == 0 || scatter > step {
        return None;
    }
    let noise = step * noise_in_steps(&counts);
    let mean_sd = variance(noise, step).sqrt();
    let of_mean = scatter * (holds.len() as f64 / samples as f64).sqrt();
    (mean_sd > 0.25 * of_mean).then_some(CoarseAxis { axis, step, noise, mean_sd })
}

/// `V`.
fn variance(noise: f64, step: f64) -> f64 {
    let term = |k: i32| (-(2.0 * PI * f64::from(k) * noise / step).powi(2)).exp() / f64::from(k * k);
    // the rest of Σ 1/k², where there is no noise
    let rest = if noise > 0.0 { 0.0 } else { 1.0 / (f64::from(TERMS) + 0.5) };
    (step / PI).powi(2) / 2.0 * ((1..=TERMS).map(term).sum::<f64>() + rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;
    use crate::simulate::{Purpose, stream};
    use rand::RngExt;
    use rand_distr::{Distribution, StandardNormal};

    /// Means of 400 holds at random places, rounded: what they are off, and the noise, by the rounded readings alone.
    #[test]
    fn what_means_are_off_is_that_of_simulated_holds() {
        let mut rng = stream(1, Purpose::Sensor, 0);
        let (step, count, length) = (0.01, 400, 1000);
        for ratio in [0.05, 0.1, 0.2, 0.3] {
            let (mut readings, mut squares) = (Vec::new(), 0.0);
            for _ in 0..count {
                let truth = rng.random_range(-0.1..0.1);
                let mut sum = 0.0;
                for _ in 0..length {
                    let z: f64 = StandardNormal.sample(&mut rng);
                    let y = ((truth + ratio * step * z) / step).round();
                    sum += y * step - truth;
                    readings.push(Vector3::new(y * step, 0.0, 0.0));
                }
                squares += (sum / f64::from(length)).powi(2);
            }
            let recording = Recording {
                times_s: (0..readings.len()).map(|k| k as f64).collect(),
                readings,
                axes: 1,
                unit: ReadingUnit::RadianPerSecond,
            };
            let holds: Vec<Range<usize>> =
                (0..count).map(|k| k * length as usize..(k + 1) * length as usize).collect();
            let found = coarse_axes(&recording, &holds);
            let [found] = found.as_slice() else { panic!("{ratio}: {found:?}") };
            let off = (squares / count as f64).sqrt();
            assert!((found.step - step).abs() < 1e-12);
            if ratio > 0.15 {
                // 400 squares know their root to 2–4 %; the mean's own noise adds a thousandth of a step
                assert!((found.mean_sd / off - 1.0).abs() < 0.15, "{ratio}: {found:?} beside {off:e}");
                assert!((found.noise / (ratio * step) - 1.0).abs() < 0.1, "{ratio}: {found:?}");
            } else {
                // no hold has three values: it counts as without noise, which is on the safe side
                assert_eq!(found.noise, 0.0);
                assert!((0.95..1.7).contains(&(found.mean_sd / off)), "{ratio}: {found:?} beside {off:e}");
            }
        }
        assert!((variance(0.0, 1.0) * 12.0 - 1.0).abs() < 1e-4);
    }
}
