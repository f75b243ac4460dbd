//! The gauge of a static calibration, which fixes its true frame, and the correction raw → true.
//!
//! Without a reference for the sensor's orientation the true frame is arbitrary: `S` and `S R` describe the
//! same sensor for every rotation `R`. A gauge picks one. The correction is `s = S⁻¹ (y − b)`. `S` and `S⁻¹`
//! are triangular (or symmetric) together, so one gauge names both directions.

use super::{Axis, Nonlinearity, Quantity, SensorModel, SensorParameters};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The convention that fixes the true frame of a static calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Gauge {
    /// Lower triangular: the true x axis lies along the sensor's x axis (Kalibr).
    Lower,
    /// Upper triangular: the true z axis lies along the sensor's z axis (imu_tk).
    Upper,
    /// Symmetric: the true frame follows the three sensor axes as closely as possible together.
    Symmetric,
}

impl Gauge {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Lower, Self::Upper, Self::Symmetric];

    /// As written in experiment files: `lower`, `upper`, `symmetric`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
            Self::Symmetric => "symmetric",
        }
    }

    /// The parameters that a static calibration in this gauge estimates: 6 for scale-bias, 9 for full.
    #[must_use]
    pub fn parameter_list(self, model: SensorModel) -> super::ParameterList {
        use Axis::{X, Y, Z};
        let mut quantities: Vec<_> = Axis::ALL.map(Quantity::Bias).to_vec();
        quantities.extend(Axis::ALL.map(Quantity::Scale));
        if model == SensorModel::Full {
            let pairs = [(X, Y), (X, Z), (Y, Z)];
            quantities.extend(pairs.map(|(one, other)| match self {
                Self::Upper => Quantity::CrossAxis(one, other),
                Self::Lower => Quantity::CrossAxis(other, one),
                Self::Symmetric => Quantity::Symmetric(one, other),
            }));
        }
        super::ParameterList::from_quantities(quantities)
    }

    /// The same sensor in this gauge: `S R` for the rotation `R` that makes it so, with a positive diagonal. The bias does not change.
    ///
    /// Lower: `S = L Q` by Gram–Schmidt on the rows of `S` (the Cholesky factor of `S Sᵀ`). Upper: the same
    /// from the last row up. Symmetric: the square root of `S Sᵀ`. A matrix of negative determinant (a
    /// left-handed sensor) keeps its magnitude: gravity alone does not determine handedness.
    #[must_use]
    pub fn apply(self, sensor: &SensorParameters) -> SensorParameters {
        let s = &sensor.matrix;
        let matrix = match self {
            Self::Lower => lower_factor(s),
            Self::Upper => {
                let flip = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0);
                flip * lower_factor(&(flip * s)) * flip
            }
            Self::Symmetric => {
                let svd = s.svd(true, false);
                let u = svd.u.unwrap_or_else(Matrix3::identity);
                u * Matrix3::from_diagonal(&svd.singular_values) * u.transpose()
            }
        };
        SensorParameters { matrix, ..*sensor }
    }
}

/// `L` of `S = L Q`: lower triangular with positive diagonal, `Q` orthogonal. Works on `S` itself, not on `S Sᵀ`, so no digits are lost.
fn lower_factor(s: &Matrix3<f64>) -> Matrix3<f64> {
    let (_, r) = s.transpose().qr().unpack();
    let mut l = r.transpose();
    for column in 0..3 {
        if l[(column, column)] < 0.0 {
            l.column_mut(column).neg_mut();
        }
    }
    l
}

/// The correction, raw → true: `s = matrix · (y − bias)`. Its parts follow imu_tk: `s = T K (y − b)`. A response that is not linear is straightened first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correction {
    /// `C = S⁻¹`, in m/s² per unit of the readings.
    pub matrix: Matrix3<f64>,
    /// Bias `b`, in the unit of the readings.
    pub bias: Vector3<f64>,
    /// What bends the response.
    pub nonlinearity: Nonlinearity,
    /// Gain of each axis: the norm of its row of `S`.
    gains: Vector3<f64>,
}

/// `M v`, written out because it runs for every sample: general products of matrices cost several times as
/// much.
#[inline]
pub(crate) fn times(m: &Matrix3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(
        m.m11 * v.x + m.m12 * v.y + m.m13 * v.z,
        m.m21 * v.x + m.m22 * v.y + m.m23 * v.z,
        m.m31 * v.x + m.m32 * v.y + m.m33 * v.z,
    )
}

impl Correction {
    /// The correction of a sensor; `None` where its matrix has no inverse.
    #[must_use]
    pub fn of(sensor: &SensorParameters) -> Option<Self> {
        let (matrix, gains) = (sensor.matrix.try_inverse()?, sensor.gains());
        Some(Self { matrix, bias: sensor.bias, nonlinearity: sensor.nonlinearity, gains })
    }

    /// Corrected reading `C (y − b)`, m/s².
    #[must_use]
    pub fn apply(&self, reading: &Vector3<f64>) -> Vector3<f64> {
        times(&self.matrix, &self.straightened(&(reading - self.bias)))
    }

    /// `S s` of a reading without its bias.
    fn straightened(&self, unbiased: &Vector3<f64>) -> Vector3<f64> {
        if self.nonlinearity.is_none() {
            return *unbiased;
        }
        Vector3::from_fn(|axis, _| {
            self.gains[axis] * self.nonlinearity.straightened(axis, unbiased[axis] / self.gains[axis])
        })
    }

    /// Derivative of the corrected reading `stimulus` with respect to the reading: `C` where the response is linear.
    #[must_use]
    pub fn by_reading(&self, sensor: &SensorParameters, stimulus: &Vector3<f64>) -> Matrix3<f64> {
        if self.nonlinearity.is_none() {
            return self.matrix;
        }
        sensor.by_stimulus(stimulus).try_inverse().unwrap_or(self.matrix)
    }

    /// Diagonal of `K` in `C = T K`, m/s² per unit of the readings: `K_j = C_jj`. Its inverse is the gain as imu_tk prints it.
    #[must_use]
    pub fn scale(&self) -> Vector3<f64> {
        self.matrix.diagonal()
    }

    /// `T` in `C = T K`: unit diagonal, `T_ij = C_ij / C_jj`.
    #[must_use]
    pub fn misalignment(&self) -> Matrix3<f64> {
        let k = self.scale();
        Matrix3::from_fn(|row, column| self.matrix[(row, column)] / k[column])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor() -> SensorParameters {
        let matrix = Matrix3::new(415.0, 2.0, -4.0, 1.0, 413.0, 3.0, 8.0, -5.0, 411.0);
        SensorParameters::linear(Vector3::new(1.0, 2.0, 3.0), matrix)
    }

    #[test]
    fn every_gauge_keeps_the_magnitude_of_corrected_readings() {
        let reading = Vector3::new(100.0, -250.0, 3000.0);
        let expected = Correction::of(&sensor()).expect("invertible").apply(&reading).norm();
        for gauge in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
            let corrected = Correction::of(&gauge.apply(&sensor())).expect("invertible").apply(&reading);
            assert!((corrected.norm() / expected - 1.0).abs() < 1e-14, "{gauge:?}");
        }
    }

    #[test]
    fn gauges_convert_into_each_other_without_loss() {
        for from in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
            for to in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
                let there = to.apply(&from.apply(&sensor()));
                assert!((there.matrix - to.apply(&sensor()).matrix).amax() < 1e-12, "{from:?} to {to:?}");
            }
        }
        let upper = Gauge::Upper.apply(&sensor()).matrix;
        assert!(upper[(1, 0)].abs() + upper[(2, 0)].abs() + upper[(2, 1)].abs() < 1e-12);
        let symmetric = Gauge::Symmetric.apply(&sensor()).matrix;
        assert!((symmetric - symmetric.transpose()).amax() < 1e-12);
    }

    #[test]
    fn scale_and_misalignment_multiply_to_the_correction() {
        let correction = Correction::of(&sensor()).expect("invertible");
        let product = correction.misalignment() * Matrix3::from_diagonal(&correction.scale());
        assert!((product - correction.matrix).amax() < 1e-18);
    }
}
