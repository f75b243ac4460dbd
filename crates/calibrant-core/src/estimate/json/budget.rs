//! The budget of the variances as JSON.

use crate::estimate::{BudgetRow, VarianceSource};
use schemars::JsonSchema;
use serde::Serialize;

/// The variance of each of the sensor's parameters, by source.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Budget {
    /// The sources, in the order of the columns.
    sources: Vec<&'static str>,
    /// Shares of the variance, a row for each parameter.
    shares: Vec<Vec<f64>>,
}

impl Budget {
    /// These sources of a budget.
    #[must_use]
    pub fn of(rows: &[BudgetRow], sources: &[VarianceSource]) -> Self {
        let shares = |row: &BudgetRow| sources.iter().map(|source| row.share(*source)).collect();
        Self {
            sources: sources.iter().map(|source| source.name()).collect(),
            shares: rows.iter().map(shares).collect(),
        }
    }
}
