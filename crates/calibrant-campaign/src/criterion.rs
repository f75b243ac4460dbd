//! What a campaign minimises.

use crate::Channel;
use calibrant_core::sensor::legendre::mean_square;
use nalgebra::DMatrix;

/// The criterion of a campaign, from the information `M_c` of each channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CampaignCriterion {
    /// `Σ_c tr(W_c M_c⁻¹)`, with the mean of the polynomial's variance over the range, over the goal squared: the number of channels where every goal is met on average.
    I,
    /// `−Σ_c ln det M_c`.
    D,
    /// The variance at one temperature, °C, over the goal squared.
    C(f64),
}

/// A temperature as `−1 … 1` over the range.
pub(crate) fn over_range([low, high]: [f64; 2], temperature_c: f64) -> f64 {
    (2.0 * temperature_c - low - high) / (high - low)
}

impl CampaignCriterion {
    /// As in files: `I`, `D`, `c`.
    #[must_use]
    pub fn letter(self) -> &'static str {
        match self {
            Self::I => "I",
            Self::D => "D",
            Self::C(_) => "c",
        }
    }

    /// Is the criterion a logarithm, so that differences count, not ratios?
    #[must_use]
    pub fn is_logarithm(self) -> bool {
        self == Self::D
    }

    /// How far a value is above a bound: a share of it, or a difference for D.
    pub(crate) fn gap(self, value: f64, bound: f64) -> f64 {
        if self.is_logarithm() { value - bound } else { value / bound - 1.0 }
    }

    /// `W_c`, what is of interest in a channel's covariance.
    pub(crate) fn interest(self, range_c: [f64; 2], channel: &Channel) -> DMatrix<f64> {
        let count = channel.coefficients();
        let weight = channel.goal_sd.powi(-2);
        match self {
            Self::C(temperature_c) => {
                let row = channel.polynomial_row(over_range(range_c, temperature_c));
                &row * row.transpose() * weight
            }
            Self::I | Self::D => DMatrix::from_fn(count, count, |i, j| {
                if i == j && i < channel.polynomial() { mean_square(i) * weight } else { 0.0 }
            }),
        }
    }

    /// Its value; `None` where the information leaves a coefficient open.
    pub(crate) fn value(
        self,
        range_c: [f64; 2],
        channels: &[Channel],
        information: &[DMatrix<f64>],
    ) -> Option<f64> {
        let of = |(channel, information): (&Channel, &DMatrix<f64>)| {
            let factor = information.clone().cholesky()?;
            Some(match self {
                Self::D => -2.0 * factor.l_dirty().diagonal().iter().map(|entry| entry.ln()).sum::<f64>(),
                Self::I | Self::C(_) => factor.solve(&self.interest(range_c, channel)).trace(),
            })
        };
        channels.iter().zip(information).map(of).sum::<Option<f64>>().filter(|value| value.is_finite())
    }

    /// `G_c`, the negative gradient of the criterion by `M_c`: `M⁻¹ W M⁻¹`, or `M⁻¹`. `None` as for the value.
    pub(crate) fn gradient(
        self,
        range_c: [f64; 2],
        channels: &[Channel],
        information: &[DMatrix<f64>],
    ) -> Option<Vec<Gradient>> {
        let of = |(channel, information): (&Channel, &DMatrix<f64>)| {
            let inverse = information.clone().cholesky()?.inverse();
            let gradient = match self {
                Self::D => inverse.clone(),
                Self::I | Self::C(_) => &inverse * self.interest(range_c, channel) * &inverse,
            };
            Some(Gradient { inverse, gradient })
        };
        channels.iter().zip(information).map(of).collect()
    }

    /// The factor of the second derivative: `tr(A M⁻¹ B G)` times this.
    pub(crate) fn curvature(self) -> f64 {
        if self == Self::D { 1.0 } else { 2.0 }
    }
}

/// A channel's covariance and gradient.
pub(crate) struct Gradient {
    pub(crate) inverse: DMatrix<f64>,
    pub(crate) gradient: DMatrix<f64>,
}
