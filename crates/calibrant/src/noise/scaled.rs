//! The same noise in another unit: everything but times and statistics is proportional to the readings.

use super::{AllanDeviation, AxisNoise, Coefficient, Drift, NoiseFit, NoiseModel};

impl AxisNoise {
    /// The noise of the readings times a positive factor.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            axis: self.axis,
            allan: self.allan.scaled(factor),
            fit: self.fit.scaled(factor),
            sample_sd: factor * self.sample_sd,
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
        let drift = Drift { per_s: factor * self.drift.per_s, sd: factor * self.drift.sd };
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
