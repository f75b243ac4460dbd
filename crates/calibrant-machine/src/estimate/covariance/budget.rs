//! Where the variance of each parameter comes from.
//!
//! The estimate is linear in the data near the optimum. With `I_s` the information of source `s`, its part of the covariance is `Σ I_s Σ`: for a prior `I_s` is
//! that of the prior; the noise of a sensor adds `(Σ a)(Σ a)ᵀ` for each whitened row `a`. What is left is the noise of the reference.

use crate::estimate::noise::posterior::Posterior;
use crate::estimate::problem::layout::Layout;
use crate::estimate::{BudgetRow, MachineQuantity, MachineTrust, Source};
use nalgebra::DMatrix;

/// The budget of the sensor's parameters. `covariance` is the stated one: parts are scaled to it. `second` is its part of second order in the mounting.
pub(crate) fn budget(
    layout: &Layout,
    posterior: &Posterior,
    covariance: &DMatrix<f64>,
    second: &DMatrix<f64>,
    trust: MachineTrust,
) -> Vec<BudgetRow> {
    let sigma = &posterior.covariance;
    let of_source = |source: Source| -> DMatrix<f64> {
        let places: Vec<usize> =
            (0..layout.len()).filter(|k| layout.quantities[*k].source() == Some(source)).collect();
        let columns = sigma.select_columns(&places);
        let prior = layout.prior.select_columns(&places).select_rows(&places);
        let by_prior = &columns * prior;
        DMatrix::from_fn(layout.len(), 1, |i, _| by_prior.row(i).dot(&columns.row(i)))
    };
    let priors: Vec<(Source, DMatrix<f64>)> =
        [Source::Geometry, Source::Mounting, Source::Timing, Source::Gravity]
            .map(|s| (s, of_source(s)))
            .into();
    (layout.quantities.iter().enumerate())
        .filter_map(|(i, quantity)| match quantity {
            MachineQuantity::Imu(of) => Some((i, *of)),
            _ => None,
        })
        .map(|(i, quantity)| {
            let model_variance = sigma[(i, i)];
            let scale = (covariance[(i, i)] - second[(i, i)]) / model_variance;
            let mut parts = [0.0; Source::ALL.len()];
            for (part, source) in parts.iter_mut().zip(Source::ALL) {
                *part = match source {
                    Source::SensorNoise => posterior.sums.of_streams.iter().map(|of| of[i]).sum(),
                    Source::ReferenceNoise => 0.0,
                    _ => priors.iter().find(|(of, _)| *of == source).map_or(0.0, |(_, of)| of[(i, 0)]),
                };
            }
            let rest = (model_variance - parts.iter().sum::<f64>()).max(0.0);
            let place = match trust {
                MachineTrust::Noisy => Source::ReferenceNoise,
                MachineTrust::Known => Source::SensorNoise,
            };
            let at = |wanted: Source| Source::ALL.iter().position(|source| *source == wanted).unwrap_or(0);
            parts[at(place)] += rest;
            let mut parts = parts.map(|part| part * scale);
            parts[at(Source::Mounting)] += second[(i, i)];
            BudgetRow { quantity, variance: covariance[(i, i)], parts }
        })
        .collect()
}
