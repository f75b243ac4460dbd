//! Is the covariance right where residuals are correlated in time? The scatter of the scores tells (`newey1987`).
//!
//! `g_b` is the score of a block of time: what its samples add to the gradient of the parameters, the motion eliminated, and `H_b` its information. Without the
//! block the estimate moves by `d_b = (H − H_b)⁻¹ g_b`, so `(B − 1)/B Σ_b d_b d_bᵀ` estimates the covariance of the data's part (the jackknife). Where the
//! reference's error is correlated over many samples, it exceeds what independent residuals give, `Σ (H − P) Σ` with the information `P` of the priors. Where few
//! blocks tell a parameter, as the faces of six poses do, independent residuals give more: `E d_b d_bᵀ = Σ H_b (H − H_b)⁻¹`, since the variance of `g_b` is
//! `H_b − H_b Σ H_b`. By the sum of these the scatter is judged, and a variance is told by `(Σ e_b)²/Σ e_b²` blocks that have the parts `e_b` of it.
//!
//! Where the variance of each parameter comes from.
//!
//! The estimate is linear in the data near the optimum. With `I_s` the information of source `s`, its part of the covariance is `Σ I_s Σ`: for a prior `I_s` is
//! that of the prior; the noise of a sensor adds `(Σ a)(Σ a)ᵀ` for each whitened row `a`. What is left is the noise of the reference.
//

use crate::estimate::least_squares::{Block, Scaled};
use crate::estimate::noise::Posterior;
use crate::estimate::problem::Layout;
use crate::estimate::{MachineQuantity, MachineTrust};
use calibrant_core::estimate::{BudgetRow, VarianceSource};
use calibrant_core::sensor::SensorKind;
use nalgebra::{DMatrix, DVector};

/// Fewest blocks that tell a variance.
const FEWEST: usize = 8;
/// A parameter of which the data tell less than this part of the variance is known from elsewhere.
const TOLD: f64 = 0.01;

/// The factor by which the standard deviation of each parameter exceeds that of independent residuals; 1 where the difference is not significant.
/// Blocks of several lengths tell: each is twice as long as the one before. The largest factor counts.
pub(crate) fn inflation(
    layout: &Layout,
    covariance: &DMatrix<f64>,
    information: &DMatrix<f64>,
    blocks: &[Block],
) -> Vec<f64> {
    let mut largest = vec![1.0; layout.len()];
    let mut blocks = blocks.to_vec();
    while blocks.len() >= FEWEST {
        let factors = of_blocks(layout, covariance, information, &blocks);
        for (largest, factor) in largest.iter_mut().zip(factors) {
            *largest = f64::max(*largest, factor);
        }
        blocks = blocks.chunks(2).map(|pair| pair[1..].iter().fold(pair[0].clone(), Block::with)).collect();
    }
    largest
}

fn of_blocks(
    layout: &Layout,
    covariance: &DMatrix<f64>,
    information: &DMatrix<f64>,
    blocks: &[Block],
) -> Vec<f64> {
    let number = blocks.len() as f64;
    let mut moved = DVector::zeros(layout.len());
    for block in blocks {
        let without = Scaled::new(&(information - &block.information));
        let step = without.map_or_else(|| covariance * &block.score, |without| without.solve(&block.score));
        moved += step.map(|step| step * step * (number - 1.0) / number);
    }
    let by_prior = covariance * &layout.prior * covariance;
    let all = |k: usize| covariance[(k, k)];
    let of_data = |k: usize| all(k) - by_prior[(k, k)];
    let told: Vec<usize> = (0..layout.len()).filter(|k| of_data(*k) > TOLD * all(*k)).collect();
    // the parameters of a class share a verdict: one ratio alone is uncertain by √(2/blocks)
    let limit = |number: f64| 1.0 + 2.0 * (2.0 / number).sqrt();
    let mean_of = |k: usize, of: &dyn Fn(usize) -> f64| {
        let alike =
            told.iter().filter(|other| class(layout.quantities[**other]) == class(layout.quantities[k]));
        let (sum, count) = alike.fold((0.0, 0.0), |(sum, count), k| (sum + of(*k), count + 1.0));
        sum / count
    };
    let mut factors = vec![1.0; layout.len()];
    // what is expected is never less than `of_data`, and takes longer
    if !told.iter().any(|k| mean_of(*k, &|k| moved[k] / of_data(k)) > limit(number)) {
        return factors;
    }
    let expected = expected(covariance, information, blocks);
    for k in &told {
        let mean = mean_of(*k, &|k| moved[k] / expected.sums[k]);
        if mean > limit(mean_of(*k, &|k| expected.numbers[k])) {
            // its own ratio scatters: where it is less than the class's mean, this counts
            let wider = of_data(*k) * (moved[*k] / expected.sums[*k]).max(mean);
            factors[*k] = ((wider + by_prior[(*k, *k)]) / all(*k)).sqrt();
        }
    }
    factors
}

/// What independent residuals give.
struct Expected {
    /// Of each parameter the sum over the blocks.
    sums: Vec<f64>,
    /// The number of blocks that tell it.
    numbers: Vec<f64>,
}

fn expected(covariance: &DMatrix<f64>, information: &DMatrix<f64>, blocks: &[Block]) -> Expected {
    let (size, number) = (covariance.nrows(), blocks.len() as f64);
    let (mut sums, mut squares) = (vec![0.0; size], vec![0.0; size]);
    for block in blocks {
        let without = Scaled::new(&(information - &block.information));
        let without = without.map_or_else(|| covariance.clone(), |without| without.inverse());
        let part = covariance * &block.information;
        for k in 0..size {
            let one = (part.row(k) * without.column(k))[0] * (number - 1.0) / number;
            sums[k] += one;
            squares[k] += one * one;
        }
    }
    let numbers = sums.iter().zip(&squares).map(|(sum, square)| sum * sum / square).collect();
    Expected { sums, numbers }
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

/// The budget of the sensor's parameters. `covariance` is the stated one: parts are scaled to it. `beyond` is what the mounting adds to the variances beyond first order.
pub(crate) fn budget(
    layout: &Layout,
    posterior: &Posterior,
    covariance: &DMatrix<f64>,
    beyond: &[f64],
    trust: MachineTrust,
) -> Vec<BudgetRow> {
    let sigma = &posterior.covariance;
    let of_source = |source: VarianceSource| -> DMatrix<f64> {
        let places: Vec<usize> =
            (0..layout.len()).filter(|k| layout.quantities[*k].source() == source).collect();
        let columns = sigma.select_columns(&places);
        let prior = layout.prior.select_columns(&places).select_rows(&places);
        let by_prior = &columns * prior;
        DMatrix::from_fn(layout.len(), 1, |i, _| by_prior.row(i).dot(&columns.row(i)))
    };
    let priors: Vec<(VarianceSource, DMatrix<f64>)> = [
        VarianceSource::Geometry,
        VarianceSource::Mounting,
        VarianceSource::Timing,
        VarianceSource::Gravity,
        VarianceSource::SensorPrior,
    ]
    .map(|s| (s, of_source(s)))
    .into();
    (layout.quantities.iter().enumerate())
        .filter_map(|(i, quantity)| match quantity {
            MachineQuantity::Imu(of) => Some((i, *of)),
            _ => None,
        })
        .map(|(i, quantity)| {
            let model_variance = sigma[(i, i)];
            let mut parts = [0.0; VarianceSource::ALL.len()];
            for (part, source) in parts.iter_mut().zip(VarianceSource::ALL) {
                *part = match source {
                    VarianceSource::SensorNoise => posterior.sums.of_streams.iter().map(|of| of[i]).sum(),
                    VarianceSource::ReferenceNoise => 0.0,
                    _ => priors.iter().find(|(of, _)| *of == source).map_or(0.0, |(_, of)| of[(i, 0)]),
                };
            }
            let rest = (model_variance - parts.iter().sum::<f64>()).max(0.0);
            let place = match trust {
                MachineTrust::Noisy => VarianceSource::ReferenceNoise,
                MachineTrust::Known => VarianceSource::SensorNoise,
            };
            parts[place as usize] += rest;
            // the noise is that of some intervals, so the parts are those of the variance only about
            let scale = (covariance[(i, i)] - beyond[i]) / parts.iter().sum::<f64>();
            let mut parts = parts.map(|part| part * scale);
            parts[VarianceSource::Mounting as usize] += beyond[i];
            BudgetRow { quantity, variance: covariance[(i, i)], parts }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::chains_for_tests::Numbers;
    use crate::estimate::{MachineParameters, MachineSetup};
    use calibrant_core::sensor::{ImuParameters, ImuQuantity, ParameterList, SensorModel};

    /// Six poses: each parameter is told by two of sixteen blocks. Independent residuals must not widen anything; without the expectation they did, by √2.
    #[test]
    fn parameters_that_few_blocks_tell_are_not_widened_by_independent_residuals() {
        let imu = ImuParameters::identity();
        let setup = MachineSetup { lever_sd_m: 0.0, tilt_sd_rad: 0.0, ..MachineSetup::default() };
        let list = ParameterList::new(3, SensorModel::Full);
        let quantities: Vec<ImuQuantity> =
            list.quantities().iter().map(|of| ImuQuantity::Of(SensorKind::Accelerometer, *of)).collect();
        let nominal = MachineParameters::nominal(&setup, imu, 0);
        let layout = Layout::new(&setup, &[SensorKind::Accelerometer], &quantities, nominal);
        let (number, size, told) = (16, layout.len(), quantities.len());
        let mut numbers = Numbers(7);
        // a variance of 1, from twelve uniform numbers
        let mut normal = || (0..12).map(|_| numbers.next(0.5)).sum::<f64>();
        let (mut widened, trials) = (0, 30);
        for _ in 0..trials {
            // one row of each parameter in each of its two blocks
            let rows = |block: usize| (0..told).filter(move |k| block % 8 == k % 8);
            let residuals: Vec<Vec<f64>> =
                (0..number).map(|block| rows(block).map(|_| normal()).collect()).collect();
            let mut information = layout.prior.clone();
            (0..number).flat_map(rows).for_each(|k| information[(k, k)] += 1.0);
            let covariance = Scaled::new(&information).expect("all are told").inverse();
            let mut gradient = DVector::zeros(size);
            for (block, of) in residuals.iter().enumerate() {
                rows(block).zip(of).for_each(|(k, residual)| gradient[k] += residual);
            }
            let estimate = &covariance * gradient;
            let block = |(block, of): (usize, &Vec<f64>)| {
                let (mut score, mut part) = (DVector::zeros(size), DMatrix::zeros(size, size));
                for (k, residual) in rows(block).zip(of) {
                    score[k] += residual - estimate[k];
                    part[(k, k)] += 1.0;
                }
                Block { score, information: part }
            };
            let blocks: Vec<Block> = residuals.iter().enumerate().map(block).collect();
            let factors = inflation(&layout, &covariance, &information, &blocks);
            widened += usize::from(factors.iter().any(|factor| *factor > 1.0));
        }
        assert!(widened <= 4, "{widened} of {trials}");
    }
}
