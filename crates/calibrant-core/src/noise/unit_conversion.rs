//! The conversion of noise results to another unit: everything but times and statistics is proportional to
//! the readings.

use super::{AxisNoise, Coefficient, NoiseModel};

impl AxisNoise {
    /// Multiplies the readings by a positive factor.
    pub(super) fn scale(&mut self, factor: f64) {
        let NoiseModel { quantisation, random_walk, bias_instability, rate_random_walk, squares } =
            &mut self.fit.model;
        for coefficient in [quantisation, random_walk, bias_instability, rate_random_walk] {
            match coefficient {
                Coefficient::Determined(estimate) => *estimate = estimate.scaled(factor),
                Coefficient::NotDetermined { limit, .. } => {
                    limit.iter_mut().for_each(|limit| *limit *= factor)
                }
            }
        }
        squares.iter_mut().for_each(|square| *square *= factor * factor);
        let points =
            self.allan.points.iter_mut().flat_map(|at| [&mut at.deviation, &mut at.low, &mut at.high]);
        let outliers = self.outliers.iter_mut();
        let outliers = outliers.flat_map(|of| [&mut of.largest].into_iter().chain(&mut of.white_with_them));
        let drift = &mut self.fit.drift;
        let others = [&mut self.sample_sd, &mut drift.per_s, &mut drift.sd, &mut drift.most_sd];
        points.chain(outliers).chain(others).for_each(|value| *value *= factor);
    }
}
