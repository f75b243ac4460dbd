//! Criterion I: the mean variance of the corrected reading, which the user finally reads.

use crate::sensor::{Axis, ParameterList, Quantity, SensorParameters};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Mean variance of the corrected reading over the operating range.
///
/// The corrected reading is `ŝ = S⁻¹ (y − b)`, so an error of the parameters changes it by
/// `δŝ = −S⁻¹ (δb + δS s)`. This is averaged over `s` uniform in `[−R, R]³` (independent components of
/// variance `R²/3`) and summed over the axes:
///
/// `Φ_I(C) = E ‖δŝ‖² = tr(Q C_bb) + R²/3 Σ_j tr(Q C_{S_j S_j})`, `Q = S⁻ᵀ S⁻¹`, `S_j` column j of `S`.
///
/// # Units
/// m²/s⁴, for all axes together. The parameters need no scale: their units are accounted for.
///
/// # References
/// `pukelsheim2006`
#[derive(Debug, Clone, PartialEq)]
pub struct IOptimality {
    /// The matrix `W` in `Φ_I = tr(W C)`.
    weight: DMatrix<f64>,
}

impl IOptimality {
    /// The criterion for these parameters of a sensor like `at`, used up to `range_mps2` on each of `axes` axes.
    ///
    /// Returns `None` where `S` is singular.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::information::criterion::{Criterion, IOptimality};
    /// use calibrant_core::sensor::{ParameterList, SensorModel, SensorParameters};
    /// use nalgebra::DMatrix;
    /// // one axis, perfect sensor, bias and scale factor of variance 1 and 3, range 2: 1 + 3 · 2²/3
    /// let list = ParameterList::new(1, SensorModel::ScaleBias);
    /// let i = IOptimality::new(&list, &SensorParameters::identity(), 2.0).expect("regular");
    /// let c = DMatrix::from_row_slice(2, 2, &[1.0, 0.5, 0.5, 3.0]);
    /// assert_eq!(Criterion::I(i).value(&c), 5.0);
    /// ```
    #[must_use]
    pub fn new(list: &ParameterList, at: &SensorParameters, range_mps2: f64) -> Option<Self> {
        let inverse = at.matrix.try_inverse()?;
        let q: Matrix3<f64> = inverse.tr_mul(&inverse);
        let moment = range_mps2 * range_mps2 / 3.0;
        let quantities = list.quantities();
        // the reading that a quantity changes, and the entry of (1, s) that it multiplies: bias is entry 0
        let unit = |axis: Axis| Vector3::ith(axis.index(), 1.0);
        let terms = |quantity: Quantity| -> Vec<(Vector3<f64>, usize)> {
            match quantity {
                Quantity::Bias(axis) => vec![(unit(axis), 0)],
                Quantity::Scale(axis) => vec![(unit(axis), 1 + axis.index())],
                Quantity::CrossAxis(row, column) => vec![(unit(row), 1 + column.index())],
                Quantity::Symmetric(row, column) => {
                    vec![(unit(row), 1 + column.index()), (unit(column), 1 + row.index())]
                }
                // of holds only, where stimuli do not fill a range
                Quantity::Nonlinear(..) => Vec::new(),
            }
        };
        let weight = DMatrix::from_fn(list.len(), list.len(), |i, j| {
            let mut sum = 0.0;
            for (reading, entry) in terms(quantities[i]) {
                for (other, other_entry) in terms(quantities[j]) {
                    if entry == other_entry {
                        sum += reading.dot(&(q * other)) * if entry == 0 { 1.0 } else { moment };
                    }
                }
            }
            sum
        });
        Some(Self { weight })
    }

    pub(super) fn restricted(&self, places: &[usize]) -> Self {
        Self { weight: self.weight.select_rows(places).select_columns(places) }
    }

    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        self.weight.dot(covariance)
    }

    pub(super) fn derivative(&self) -> DMatrix<f64> {
        self.weight.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorModel;

    #[test]
    fn i_equals_the_average_over_the_corners_of_a_two_point_range() {
        // a uniform variable has the second moment of one that is ±R/√3
        let list = ParameterList::new(3, SensorModel::Full);
        let at = SensorParameters {
            bias: Vector3::new(0.1, -0.2, 0.3),
            matrix: Matrix3::new(1.1, 0.02, -0.03, 0.01, 0.9, 0.05, -0.04, 0.02, 1.3),
            ..SensorParameters::identity()
        };
        let factor = DMatrix::from_fn(12, 12, |i, j| ((3 * i + 7 * j + i * j) as f64).sin());
        let covariance = &factor * factor.transpose();
        let inverse = at.matrix.try_inverse().expect("regular");
        let r = 5.0;
        let mut mean = 0.0;
        for corner in 0..8_u32 {
            let s = Vector3::from_fn(|k, _| if corner >> k & 1 == 1 { r } else { -r } / 3.0_f64.sqrt());
            let g =
                DMatrix::from_fn(3, 12, |row, k| (inverse * list.quantities()[k].derivative(&at, &s))[row]);
            mean += (&g * &covariance * g.transpose()).trace() / 8.0;
        }
        let value = IOptimality::new(&list, &at, r).expect("regular").value(&covariance);
        assert!((value / mean - 1.0).abs() < 1e-13, "{value} {mean}");
    }
}
