//! Degrees of freedom behind a covariance: how well its own size is known.
//!
//! A variance that is the scatter of a few holds is itself uncertain. With ν residuals more than unknowns, a difference over its standard
//! deviation follows Student's t of ν degrees of freedom. Each part of an IMU has a scatter of its own.

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

/// Quantities that one scatter determines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CovariancePart {
    Accelerometer,
    GyroscopeAtRest,
    GyroscopeMatrix,
}

impl CovariancePart {
    /// Every part.
    pub(crate) const ALL: [Self; 3] = [Self::Accelerometer, Self::GyroscopeAtRest, Self::GyroscopeMatrix];
}

impl CovarianceDegrees {
    /// Of variances that are known.
    #[must_use]
    pub fn known() -> Self {
        let known = f64::INFINITY;
        Self { accelerometer: known, gyroscope_at_rest: known, gyroscope_matrix: known }
    }

    /// Those of a part.
    pub(crate) fn of_part(&self, part: CovariancePart) -> f64 {
        match part {
            CovariancePart::Accelerometer => self.accelerometer,
            CovariancePart::GyroscopeAtRest => self.gyroscope_at_rest,
            CovariancePart::GyroscopeMatrix => self.gyroscope_matrix,
        }
    }
}
