//! The conversion of noise results to another unit: everything but times and statistics is proportional to
//! the readings.

use super::{AllanDeviation, AxisNoise, Coefficient, Drift, NoiseFit, NoiseModel, Outliers};

impl AxisNoise {
    /// The noise of the readings times a positive factor.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            axis: self.axis,
            allan: self.allan.scaled(factor),
            fit: self.fit.scaled(factor),
            sample_sd: factor * self.sample_sd,
            outliers: self.outliers.as_ref().map(|outliers| outliers.scaled(factor)),
        }
    }
}

impl Outliers {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            largest: factor * self.largest,
            white_with_them: self.white_with_them.map(|white| factor * white),
            ..self.clone()
        }
    }
}

impl AllanDeviation {
    fn scaled(&self, factor: f64) -> Self {
        let mut allan = self.clone();
        for point in &mut allan.points {
            point.deviation *= factor;
            point.low *= factor;
            point.high *= factor;
        }
        allan
    }
}

impl NoiseFit {
    fn scaled(&self, factor: f64) -> Self {
        let of = &self.drift;
        let drift = Drift { per_s: factor * of.per_s, sd: factor * of.sd, most_sd: factor * of.most_sd };
        Self { model: self.model.scaled(factor), drift, ..self.clone() }
    }
}

impl NoiseModel {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            quantisation: self.quantisation.scaled(factor),
            random_walk: self.random_walk.scaled(factor),
            bias_instability: self.bias_instability.scaled(factor),
            rate_random_walk: self.rate_random_walk.scaled(factor),
            squares: self.squares.map(|square| factor * factor * square),
        }
    }
}

impl Coefficient {
    fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Determined(estimate) => Self::Determined(estimate.scaled(factor)),
            Self::NotDetermined { limit, reason } => {
                Self::NotDetermined { limit: limit.map(|limit| factor * limit), reason: reason.clone() }
            }
        }
    }
}
