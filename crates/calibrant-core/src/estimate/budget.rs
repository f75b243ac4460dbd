//! The budget: what the variance of each parameter is made of.

use crate::sensor::ImuQuantity;
use crate::solve::{Uncertainty, VarianceSource};

/// The variance of one of the sensor's parameters, by its sources.
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetRow {
    /// The parameter.
    pub quantity: ImuQuantity,
    /// Its variance.
    pub variance: f64,
    /// Parts of it, in the order of [`VarianceSource::ALL`]. Their sum is the variance.
    pub parts: [f64; VarianceSource::ALL.len()],
}

impl BudgetRow {
    /// Those of an uncertainty.
    pub(super) fn all(uncertainty: &Uncertainty, quantities: &[ImuQuantity]) -> Vec<Self> {
        let row = |(k, quantity): (usize, &ImuQuantity)| {
            let variance = uncertainty.covariance[(k, k)];
            Self { quantity: *quantity, variance, parts: uncertainty.parts(k) }
        };
        quantities.iter().enumerate().map(row).collect()
    }

    /// The part of a source.
    #[must_use]
    pub fn part(&self, source: VarianceSource) -> f64 {
        self.parts[source as usize]
    }

    /// Its share of the variance, 0 to 1.
    #[must_use]
    pub fn share(&self, source: VarianceSource) -> f64 {
        self.part(source) / self.variance
    }

    /// More of a source.
    pub fn add(&mut self, source: VarianceSource, variance: f64) {
        self.variance += variance;
        self.parts[source as usize] += variance;
    }
}
