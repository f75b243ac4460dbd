//! Is the covariance right where residuals are correlated in time? The scatter of the scores tells (`newey1987`).
//!
//! `g_b` is the score of a block of time: what its samples add to the gradient of the parameters, the motion eliminated. With independent residuals
//! `Σ_b g_b g_bᵀ` estimates the information `Σ⁻¹`. Where the reference's error is correlated over many samples, the scores scatter more, and the variance of
//! parameter `i` is `Σ_b (Σ g_b)_i²`.

use crate::estimate::MachineQuantity;
use calibrant_core::sensor::SensorKind;
use nalgebra::{DMatrix, DVector};

/// Fewest blocks that tell a variance.
const FEWEST: usize = 12;

/// The shortest block for a recording of this duration, s.
fn shortest_s(duration_s: f64) -> f64 {
    (duration_s / 60.0).clamp(0.5, 3.0)
}

/// The factor by which the standard deviation of each parameter exceeds that of independent residuals; 1 where the difference is not significant.
/// Blocks of several lengths tell: each is twice as long as the one before. The largest factor counts.
pub(crate) fn inflation(
    quantities: &[MachineQuantity],
    covariance: &DMatrix<f64>,
    scores: &[(f64, DVector<f64>)],
) -> Vec<f64> {
    let mut largest = vec![1.0; quantities.len()];
    let (Some((first, _)), Some((last, _))) = (scores.first(), scores.last()) else { return largest };
    let mut length_s = shortest_s(last - first);
    loop {
        let blocks = blocks(scores, length_s);
        if blocks.len() < FEWEST {
            return largest;
        }
        for (largest, factor) in largest.iter_mut().zip(of_blocks(quantities, covariance, &blocks)) {
            *largest = f64::max(*largest, factor);
        }
        length_s *= 2.0;
    }
}

/// Sums of the scores over blocks of this length; blocks without samples are left out.
fn blocks(scores: &[(f64, DVector<f64>)], length_s: f64) -> Vec<DVector<f64>> {
    let first = scores[0].0;
    let mut blocks: Vec<DVector<f64>> = Vec::new();
    let mut place = usize::MAX;
    for (time, score) in scores {
        let block = ((time - first) / length_s) as usize;
        if block == place {
            if let Some(sum) = blocks.last_mut() {
                *sum += score;
            }
        } else {
            place = block;
            blocks.push(score.clone());
        }
    }
    blocks.retain(|score| score.amax() > 0.0);
    blocks
}

fn of_blocks(quantities: &[MachineQuantity], covariance: &DMatrix<f64>, blocks: &[DVector<f64>]) -> Vec<f64> {
    let mut variance = DVector::zeros(quantities.len());
    for block in blocks {
        variance += (covariance * block).map(|step| step * step);
    }
    let ratios: Vec<f64> = (0..quantities.len()).map(|k| variance[k] / covariance[(k, k)]).collect();
    // the parameters of a class share a verdict: one ratio alone is uncertain by √(2/blocks)
    let classes: Vec<usize> = quantities.iter().map(|quantity| class(*quantity)).collect();
    let limit = 1.0 + 2.0 * (2.0 / blocks.len() as f64).sqrt();
    let significant = |class: usize| {
        let of: Vec<f64> = (0..ratios.len()).filter(|k| classes[*k] == class).map(|k| ratios[k]).collect();
        of.iter().sum::<f64>() > limit * of.len() as f64
    };
    (0..ratios.len()).map(|k| if significant(classes[k]) { ratios[k].max(1.0).sqrt() } else { 1.0 }).collect()
}

/// Parameters that the same residuals determine.
fn class(quantity: MachineQuantity) -> usize {
    match quantity {
        MachineQuantity::Imu(of) if of.sensor_kind() == SensorKind::Accelerometer => 0,
        MachineQuantity::Imu(_) => 1,
        MachineQuantity::Lever(_) => 2,
        MachineQuantity::Mounting(_) | MachineQuantity::Tilt(_) | MachineQuantity::Gravity => 3,
        MachineQuantity::Delay(_) | MachineQuantity::ClockRate => 4,
        MachineQuantity::Zero(_) | MachineQuantity::Geometry(..) => 5,
    }
}
