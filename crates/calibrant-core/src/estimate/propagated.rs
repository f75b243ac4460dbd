//! Derived figures with the standard deviation that the covariance of the estimates gives them.

use super::result::Calibration;
use crate::sensor::ImuParameters;

/// Step of a difference quotient, in standard deviations of the parameter.
const STEP_SD: f64 = 1e-3;

impl Calibration {
    /// A figure that follows from the parameters, and its standard deviation `√(gᵀ Σ g)` with the gradient `g` from central differences.
    ///
    /// # Examples
    /// ```no_run
    /// # fn calibration() -> calibrant_core::estimate::Calibration { unimplemented!() }
    /// use calibrant_core::sensor::ImuParameters;
    /// let bias_over_gain = |imu: &ImuParameters| imu.gyroscope.bias.x / imu.gyroscope.matrix.row(0).norm();
    /// let (value_radps, sd_radps) = calibration().propagated(bias_over_gain);
    /// ```
    #[must_use]
    pub fn propagated(&self, figure: impl Fn(&ImuParameters) -> f64) -> (f64, f64) {
        let sd = self.sd();
        let slopes = self.quantities.iter().zip(&sd).map(|(quantity, sd)| {
            let step = STEP_SD * sd;
            if step <= 0.0 {
                return 0.0;
            }
            let moved = |by: f64| {
                let mut imu = self.imu;
                quantity.add_to(&mut imu, by);
                figure(&imu)
            };
            (moved(step) - moved(-step)) / (2.0 * step)
        });
        let slopes = nalgebra::DVector::from_iterator(self.quantities.len(), slopes);
        let variance = slopes.dot(&(&self.covariance * &slopes));
        (figure(&self.imu), variance.max(0.0).sqrt())
    }
}
