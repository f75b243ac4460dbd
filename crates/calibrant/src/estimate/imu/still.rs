//! The gyroscope in the holds: its bias, its noise, and how far it wanders between them.

use super::joint::HoldData;
use crate::motion::Hold;
use crate::sensor::Recording;
use nalgebra::{DMatrix, DVector, Vector3};

/// Mean, number of samples and scatter of the gyroscope within a hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Still {
    pub(super) mean: Vector3<f64>,
    pub(super) samples: usize,
    squares: Vector3<f64>,
}

/// The gyroscope between the times of a hold; `None` with fewer than two samples.
pub(super) fn still(recording: &Recording, hold: &Hold) -> Option<Still> {
    let first = recording.times_s.partition_point(|&t| t < hold.start_s);
    let end = recording.times_s.partition_point(|&t| t <= hold.end_s);
    let readings = recording.readings.get(first..end).filter(|readings| readings.len() > 1)?;
    let mean = readings.iter().sum::<Vector3<f64>>() / readings.len() as f64;
    let squares = readings.iter().map(|y| (y - mean).component_mul(&(y - mean))).sum();
    Some(Still { mean, samples: readings.len(), squares })
}

/// Standard deviation of one sample, pooled over the holds.
pub(super) fn pooled_noise(stills: &[Option<Still>]) -> Vector3<f64> {
    let degrees: f64 = stills.iter().flatten().map(|still| (still.samples - 1) as f64).sum();
    let squares: Vector3<f64> = stills.iter().flatten().map(|still| still.squares).sum();
    (squares / degrees.max(1.0)).map(f64::sqrt)
}

/// The scatter between holds that makes χ² equal its degrees of freedom (Paule and Mandel), per axis; each mean is explained by a constant and, where
/// asked for, by the specific force.
pub(super) fn between_sd(
    stills: &[Option<Still>],
    noise: &Vector3<f64>,
    forces: Option<&[Vector3<f64>]>,
) -> Vector3<f64> {
    let rows: Vec<(DVector<f64>, Still)> = stills
        .iter()
        .enumerate()
        .filter_map(|(j, still)| {
            let mut row = vec![1.0];
            if let Some(forces) = forces {
                row.extend(forces[j].iter());
            }
            still.map(|still| (DVector::from_vec(row), still))
        })
        .collect();
    let unknowns = rows.first().map_or(1, |(row, _)| row.len());
    let degrees = rows.len().saturating_sub(unknowns) as f64;
    Vector3::from_fn(|axis, _| {
        if degrees == 0.0 {
            return 0.0;
        }
        let chi2 = |between: f64| -> Option<f64> {
            let weight = |still: &Still| {
                1.0 / (noise[axis].powi(2) / still.samples as f64 + between * between).max(f64::MIN_POSITIVE)
            };
            let (mut f, mut g) = (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
            for (row, still) in &rows {
                f += row * row.transpose() * weight(still);
                g += row * (weight(still) * still.mean[axis]);
            }
            let solution = f.cholesky()?.solve(&g);
            Some(
                rows.iter()
                    .map(|(row, still)| weight(still) * (still.mean[axis] - row.dot(&solution)).powi(2))
                    .sum(),
            )
        };
        let size = rows
            .iter()
            .map(|(_, still)| still.mean[axis])
            .fold((f64::MAX, f64::MIN), |(low, high), mean| (low.min(mean), high.max(mean)));
        let (mut low, mut high) = (0.0, (size.1 - size.0).max(f64::MIN_POSITIVE));
        if chi2(0.0).is_none_or(|chi2| chi2 <= degrees) {
            return 0.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if chi2(middle).is_none_or(|chi2| chi2 > degrees) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    })
}

/// Gives the holds their gyroscope means with inverse variances.
pub(super) fn weigh(
    holds: &mut [HoldData],
    stills: &[Option<Still>],
    noise: &Vector3<f64>,
    between: &Vector3<f64>,
) {
    for (hold, still) in holds.iter_mut().zip(stills) {
        hold.gyroscope = still.map(|still| {
            let variance = noise.component_mul(noise) / still.samples as f64 + between.component_mul(between);
            (still.mean, variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)))
        });
    }
}
