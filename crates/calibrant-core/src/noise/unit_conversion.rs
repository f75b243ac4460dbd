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
        for point in &mut self.allan.points {
            point.deviation *= factor;
            point.low *= factor;
            point.high *= factor;
        }
        if let Some(outliers) = &mut self.outliers {
            outliers.largest *= factor;
            outliers.white_with_them.iter_mut().for_each(|white| *white *= factor);
        }
        let drift = &mut self.fit.drift;
        for value in [&mut self.sample_sd, &mut drift.per_s, &mut drift.sd, &mut drift.most_sd] {
            *value *= factor;
        }
    }
}
