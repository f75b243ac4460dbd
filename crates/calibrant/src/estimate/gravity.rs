//! What an error of the assumed gravity does to the parameters.

use crate::motion::Gravity;
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, Triad};
use nalgebra::DVector;

/// Change of each quantity with the gravity that is assumed, `∂p/∂g = −p/g`: a common factor of the accelerometer's matrix and of the g-sensitivity. Biases and the
/// gyroscope's matrix do not depend on it. Times gravity's uncertainty it is a column of the covariance's root.
pub(super) fn gravity_slope(
    quantities: &[ImuQuantity],
    imu: &ImuParameters,
    gravity: &Gravity,
) -> DVector<f64> {
    DVector::from_iterator(
        quantities.len(),
        quantities.iter().map(|quantity| match quantity {
            ImuQuantity::Of(Triad::Accelerometer, Quantity::Bias(_))
            | ImuQuantity::Of(Triad::Gyroscope, _) => 0.0,
            _ => -quantity.of(imu) / gravity.magnitude_mps2,
        }),
    )
}
