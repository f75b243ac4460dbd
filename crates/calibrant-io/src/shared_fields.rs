//! Fields that several of the JSON files share.

use calibrant_core::estimate::{FitStatistics, Whiteness};
use calibrant_core::sensor::{Axis, ReadingUnit};
use nalgebra::{DMatrix, Vector3};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A field whose name ends in the unit of the readings: `residual_rms_mps2` or `residual_rms_counts`. To be flattened.
pub(super) struct InUnit<T> {
    name: &'static str,
    ending: &'static str,
    value: T,
}

impl<T> InUnit<T> {
    /// A value in the unit of the readings.
    pub(super) fn new(name: &'static str, unit: ReadingUnit, value: T) -> Self {
        Self { name, ending: unit.suffix(), value }
    }
}

impl<T: Serialize> Serialize for InUnit<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let separator = if self.ending.is_empty() { "" } else { "_" };
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(&format!("{}{separator}{}", self.name, self.ending), &self.value)?;
        map.end()
    }
}

/// The first entries of a vector, one for each axis.
pub(super) fn per_axis(vector: &Vector3<f64>, axes: usize) -> Vec<f64> {
    vector.iter().take(axes).copied().collect()
}

/// A matrix, row by row.
pub(super) fn matrix_rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// The quality of the fit.
#[derive(Serialize)]
pub(super) struct FitFields {
    chi2: f64,
    degrees_of_freedom: usize,
    p_value: Option<f64>,
    #[serde(flatten)]
    residual_rms: Option<InUnit<Vec<f64>>>,
    #[serde(flatten)]
    assumed_noise: Option<InUnit<Vec<f64>>>,
    #[serde(flatten)]
    noise_estimate: Option<InUnit<Vec<f64>>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    whiteness: Vec<WhitenessFields>,
}

#[derive(Serialize)]
struct WhitenessFields {
    axis: String,
    statistic: f64,
    lags: usize,
    p_value: f64,
}

impl FitFields {
    pub(super) fn of(fit: &FitStatistics, unit: ReadingUnit, axes: usize) -> Self {
        let whiteness = |(axis, test): (&Axis, &Whiteness)| WhitenessFields {
            axis: axis.to_string(),
            statistic: test.statistic,
            lags: test.lags,
            p_value: test.p_value,
        };
        let field = |name, values: &Option<Vector3<f64>>| {
            values.as_ref().map(|values| InUnit::new(name, unit, per_axis(values, axes)))
        };
        Self {
            chi2: fit.chi2,
            degrees_of_freedom: fit.degrees_of_freedom,
            p_value: fit.p_value,
            residual_rms: field("residual_rms", &fit.residual_rms),
            assumed_noise: field("assumed_noise", &fit.assumed_noise),
            noise_estimate: field("noise_estimate", &fit.noise_estimate),
            whiteness: Axis::ALL.iter().zip(&fit.whiteness).map(whiteness).collect(),
        }
    }
}
