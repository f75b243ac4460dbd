//! Errors of a calibration that another one at the same place has, too: gravity that is not exactly known, the geometry of a machine.
//!
//! The error of the quantities is `U e + r`: `e` has a standard normal component for each source and belongs to the place, `r` to the recording. So
//! `Σ = U Uᵀ + cov r`, and the covariance of the errors of two calibrations at one place is `U_A U_Bᵀ`, over the sources that are the same.

use crate::form::rows;
use crate::json_object;
use nalgebra::DMatrix;

/// Errors of a calibration that another one at the same place has, too.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedErrors {
    /// Each source, with what is stated of it: `gravity 9.80665 ± 0.019 m/s²`. At one place, equal words are one error.
    pub sources: Vec<String>,
    /// `U`: a row for each quantity of the covariance, a column for each source; what one standard deviation of the source does to the quantity.
    pub root: DMatrix<f64>,
}

json_object! {
    /// Errors that another calibration at the same place has, too: gravity that is not exactly known, the geometry of a machine.
    SharedErrors as of {
        /// Each source, with what is stated of it. At one place, equal words are one error.
        sources: &of.sources,
        /// A row for each parameter, a column for each source: what one standard deviation of the source does to the parameter, in its unit.
        root: rows(&of.root),
    }
}

impl SharedErrors {
    /// One source with its column. `None` where it does nothing.
    #[must_use]
    pub fn of_source(source: String, column: &[f64]) -> Option<Self> {
        let acts = column.iter().any(|entry| *entry != 0.0);
        acts.then(|| Self {
            sources: vec![source],
            root: DMatrix::from_column_slice(column.len(), 1, column),
        })
    }

    /// The rows of these quantities alone.
    pub(super) fn restricted(&self, kept: &[usize]) -> Self {
        Self { sources: self.sources.clone(), root: self.root.select_rows(kept) }
    }
}
