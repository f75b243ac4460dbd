//! Degrees of freedom behind a covariance: how well its own size is known.
//!
//! A variance that is the scatter of a few holds is itself uncertain. With ν residuals more than unknowns, a difference over its standard
//! deviation follows Student's t of ν degrees of freedom. Each part of an IMU has a scatter of its own.

use super::{ImuQuantity, Invariant, Quantity, SensorKind};

/// Residuals less unknowns behind each part of a covariance. Infinite where the variance was known beforehand, or where no scatter was found.
/// 0 where there are no residuals that could show one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CovarianceDegrees {
    /// Behind the parameters of the accelerometer: the scatter between holds.
    pub accelerometer: f64,
    /// Behind the bias and the g-sensitivity of the gyroscope: its scatter between holds.
    pub gyroscope_at_rest: f64,
    /// Behind the matrix of the gyroscope: the scatter between rotations.
    pub gyroscope_matrix: f64,
}

impl CovarianceDegrees {
    /// Of variances that are known.
    #[must_use]
    pub fn known() -> Self {
        Self::of_parts([f64::INFINITY; 3])
    }

    /// The number of parts.
    pub(crate) const PARTS: usize = 3;

    fn of_parts([accelerometer, gyroscope_at_rest, gyroscope_matrix]: [f64; Self::PARTS]) -> Self {
        Self { accelerometer, gyroscope_at_rest, gyroscope_matrix }
    }

    /// Those of a part, by its number.
    pub(crate) fn of_part(&self, part: usize) -> f64 {
        [self.accelerometer, self.gyroscope_at_rest, self.gyroscope_matrix][part]
    }

    /// The number of the part that a quantity belongs to.
    pub(crate) fn part_of(quantity: ImuQuantity) -> usize {
        match quantity {
            _ if quantity.sensor_kind() == SensorKind::Accelerometer => 0,
            ImuQuantity::GSensitivity(..) => 1,
            _ if quantity.is_of_bias() => 1,
            _ => 2,
        }
    }

    /// The number of the part that an invariant mainly belongs to.
    pub(crate) fn part_of_invariant(invariant: Invariant) -> usize {
        Self::part_of(match invariant {
            Invariant::Bias(of, axis) => ImuQuantity::Of(of, Quantity::Bias(axis)),
            Invariant::Gain(of, axis) | Invariant::Angle(of, axis, _) => {
                ImuQuantity::Of(of, Quantity::Scale(axis))
            }
            Invariant::AngleBetween(_, axis) => ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(axis)),
            Invariant::GSensitivity(axis) => ImuQuantity::GSensitivity(axis, axis),
            Invariant::Thermal(of, term) => ImuQuantity::Thermal(of, term),
        })
    }
}
