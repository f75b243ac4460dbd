//! A coefficient of the noise: its estimate with an interval, or the reason why the recording does not
//! determine it. The four of an axis are the noise model, which gives the Allan deviation.

use super::PowerLaw;

/// An estimate with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Standard uncertainty.
    pub sd: f64,
    /// Lower bound of the 95 % confidence interval.
    pub low: f64,
    /// Upper bound of the 95 % confidence interval.
    pub high: f64,
}

impl Estimate {
    /// The same in another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            sd: factor * self.sd,
            low: factor * self.low,
            high: factor * self.high,
        }
    }
}

/// A coefficient, determined by a recording or not.
#[derive(Debug, Clone, PartialEq)]
pub enum Coefficient {
    /// The recording determines it.
    Determined(Estimate),
    /// The recording does not determine it.
    NotDetermined {
        /// The coefficient is below this with 95 % confidence, where the recording sets a limit.
        limit: Option<f64>,
        /// Why it is not determined, and what would help.
        reason: String,
    },
}

impl Coefficient {
    /// Why it is not determined.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Determined(_) => None,
            Self::NotDetermined { reason, .. } => Some(reason),
        }
    }

    /// The estimate, where it is determined.
    #[must_use]
    pub fn estimate(&self) -> Option<&Estimate> {
        match self {
            Self::Determined(estimate) => Some(estimate),
            Self::NotDetermined { .. } => None,
        }
    }

    /// The value, where it is determined.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        self.estimate().map(|estimate| estimate.value)
    }

    /// The upper limit, where it is not determined.
    #[must_use]
    pub fn limit(&self) -> Option<f64> {
        match self {
            Self::Determined(_) => None,
            Self::NotDetermined { limit, .. } => *limit,
        }
    }
}

/// The coefficients of the noise of one axis, in the unit of the readings `u`.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseModel {
    /// Quantisation Q of the summed readings, u·s.
    pub quantisation: Coefficient,
    /// Velocity (accelerometer) or angle (gyroscope) random walk N: density of the white noise, u/√Hz.
    pub random_walk: Coefficient,
    /// Bias instability B, u; the flat part of the Allan deviation is 0.664 B.
    pub bias_instability: Coefficient,
    /// Rate random walk K, u/√s.
    pub rate_random_walk: Coefficient,
    /// Squares of all fitted coefficients, also of those that are not determined. That of quantisation is
    /// below zero where it is a filter's share.
    pub(super) squares: [f64; 4],
}

impl NoiseModel {
    /// The coefficient of a process.
    #[must_use]
    pub fn coefficient(&self, process: PowerLaw) -> &Coefficient {
        match process {
            PowerLaw::Quantisation => &self.quantisation,
            PowerLaw::White => &self.random_walk,
            PowerLaw::Flicker => &self.bias_instability,
            PowerLaw::RandomWalk => &self.rate_random_walk,
        }
    }

    /// The Allan deviation that one process contributes to the fit at cluster time `τ`, determined or not.
    #[must_use]
    pub fn share(&self, process: PowerLaw, tau_s: f64) -> f64 {
        (self.squares[process as usize].max(0.0) * process.allan_variance(tau_s)).sqrt()
    }

    /// The fitted Allan deviation: all processes together, and the filter where the fit has one.
    #[must_use]
    pub fn deviation(&self, tau_s: f64) -> f64 {
        let variance = |process: &PowerLaw| self.squares[*process as usize] * process.allan_variance(tau_s);
        PowerLaw::ALL.iter().map(variance).sum::<f64>().max(0.0).sqrt()
    }

    /// Standard deviation of the white noise of one sample, `σ_ν = N √f_s`; `None` where N is not determined.
    #[must_use]
    pub fn white_noise_per_sample(&self, rate_hz: f64) -> Option<f64> {
        Some(self.random_walk.value()? * rate_hz.sqrt())
    }
}
