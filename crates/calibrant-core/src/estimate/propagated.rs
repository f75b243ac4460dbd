//! Derived figures with the standard deviation that the covariance of the estimates gives them.

use super::result::Calibration;
use crate::sensor::ImuParameters;

/// Step of a difference quotient, in standard deviations of the parameter.
const STEP_SD: f64 = 1e-3;

impl Calibration {
    /// A figure that follows from the parameters, and its standard deviation `√(gᵀ Σ g)` with the gradient `g` from central differences.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::estimate::{CalibrationSettings, Gyroscope, ImuProblem, ImuSetup, calibrate_imu};
    /// use calibrant_core::sensor::{ImuParameters, Sensor, SensorKind, SensorModel};
    /// use calibrant_core::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
    ///
    /// let mut rng = stream(1, Purpose::Sensor, 0);
    /// let recording = simulate_imu(&ImuParameters::identity(), &ImuSimulation::default(), &mut rng);
    /// let (accelerometer, gyroscope) = (Sensor::triaxial(SensorModel::Full), Gyroscope::default());
    /// let setup = ImuSetup::default();
    /// let problem =
    ///     ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording: &recording, setup: &setup };
    /// let calibration = calibrate_imu(&problem, &CalibrationSettings::default())?;
    /// let over_the_gain = |imu: &ImuParameters| imu[SensorKind::Gyroscope].bias.x / imu[SensorKind::Gyroscope].matrix.row(0).norm();
    /// let (value_radps, sd_radps) = calibration.propagated(over_the_gain);
    /// assert!(sd_radps > 0.0 && value_radps.abs() < 5.0 * sd_radps);
    /// # Ok::<(), calibrant_core::Error>(())
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
