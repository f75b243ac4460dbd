//! The expected accuracy of a static calibration, before it is run.

use super::robust_weights;
use crate::error::Result;
use crate::information;
use crate::motion::Hold;
use crate::sensor::{Gauge, ParameterList, ReadingUnit, SensorModel, SensorParameters};
use crate::solve::ScaledInformation;
use nalgebra::{DMatrix, DVector, Vector3};

/// How well holds will determine an accelerometer.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedCalibration {
    /// The parameters, in order: those of the full model in the gauge asked for.
    pub list: ParameterList,
    /// Unit of the readings.
    pub unit: ReadingUnit,
    /// The sensor of the prediction: the sphere through the means of the holds.
    pub like: SensorParameters,
    /// Covariance `F⁻¹` of the parameters.
    pub covariance: DMatrix<f64>,
    /// Standard deviation of one sample within the holds, unit of the readings.
    pub noise: Vector3<f64>,
    /// Ratio of the largest to the smallest eigenvalue of the information scaled to unit diagonal: 1 is best.
    pub condition_number: f64,
}

impl ExpectedCalibration {
    /// Standard deviations of the parameters, each in its own unit.
    #[must_use]
    pub fn sd(&self) -> DVector<f64> {
        self.covariance.diagonal().map(f64::sqrt)
    }

    /// Standard deviations that do not depend on the sensor's gain: biases in m/s², scale factors and cross-axis sensitivities
    /// relative to the gain.
    #[must_use]
    pub fn relative_sd(&self) -> DVector<f64> {
        // the sphere has the same gain for all axes
        self.sd() / self.like.matrix[(0, 0)]
    }
}

/// The expected covariance of an accelerometer's nine parameters from these holds.
///
/// `C = F⁻¹`. `F` is the information of the holds at their own directions, with these marginalised. The noise of a mean is `σ_w²/n_j`, with `σ_w` the
/// scatter of samples within the holds. A calibration reports this covariance if the noise is white and nothing else disturbs. The scatter
/// *between* holds is usually larger, and then the standard deviations are larger too.
///
/// # Shapes and units
/// 9 × 9; entry (i, j) in unit of θᵢ · unit of θⱼ, for readings in `unit`.
///
/// # Errors
/// [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) where there are too few holds, or their directions leave a combination of parameters free.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{expected_calibration, find_holds};
/// use calibrant_core::sensor::{Gauge, ReadingUnit, SensorParameters};
/// use calibrant_core::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};
/// use nalgebra::Vector3;
///
/// let setup = HoldsSimulation { poses: 24, hold_s: 4.0, turn_s: 1.5, rate_hz: 100.0, gravity_mps2: 9.81, between_holds_sd_mps2: 0.0 };
/// let unit = ReadingUnit::MetrePerSecondSquared;
/// let (recording, _) =
///     simulate_holds(&SensorParameters::identity(), &Vector3::repeat(0.01), unit, &setup, &mut stream(1, Purpose::Sensor, 0));
/// let holds = find_holds(&recording, 1.0)?;
/// let expected = expected_calibration(&holds, unit, 9.81, Gauge::Upper)?;
/// // one hold's mean has 0.01/√400 = 0.0005 m/s²; 24 of them know a bias to a few ten thousandths
/// assert!(expected.sd()[0] > 0.0005 / 24_f64.sqrt() && expected.sd()[0] < 0.0005);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn expected_calibration(
    holds: &[Hold],
    unit: ReadingUnit,
    gravity_mps2: f64,
    gauge: Gauge,
) -> Result<ExpectedCalibration> {
    let list = gauge.parameter_list(SensorModel::Full);
    let (like, noise, information) = robust_weights::expect(holds, list.clone(), gravity_mps2)?;
    let covariance =
        information::covariance(&information).unwrap_or_else(|| DMatrix::from_element(9, 9, f64::INFINITY));
    let condition_number = ScaledInformation::of(&information).condition_number();
    Ok(ExpectedCalibration { list, unit, like, covariance, noise, condition_number })
}
