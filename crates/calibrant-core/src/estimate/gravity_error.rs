//! The effect of an error of the assumed gravity on the parameters.

use crate::motion::Gravity;
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, SensorKind, SharedErrors};
use crate::solve::{Uncertainty, VarianceSource};
use nalgebra::DVector;

impl Uncertainty {
    /// Adds the uncertainty of the assumed gravity. The derivative of each estimate with respect to gravity: times its standard deviation, a column of the
    /// covariance's root.
    pub(super) fn add_gravity(
        &mut self,
        quantities: &[ImuQuantity],
        imu: &ImuParameters,
        gravity: &Gravity,
    ) -> DVector<f64> {
        let slope = self.follow(slope_of_data(quantities, imu, gravity));
        self.add(VarianceSource::Gravity, &slope, gravity.sd_mps2.powi(2));
        slope
    }
}

/// Derivative of each quantity that data alone determine with respect to the assumed gravity, `∂p_d/∂g = −p/g`.
///
/// Gravity is a common factor of the accelerometer's matrix and of the g-sensitivity. Biases, the gyroscope's matrix and the temperature terms do not
/// depend on it. A term that bends the response as the p-th power of the force has `−(p − 1) c/g`.
fn slope_of_data(quantities: &[ImuQuantity], imu: &ImuParameters, gravity: &Gravity) -> DVector<f64> {
    DVector::from_iterator(
        quantities.len(),
        quantities.iter().map(|quantity| match quantity {
            ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(_))
            | ImuQuantity::Of(SensorKind::Gyroscope, _)
            | ImuQuantity::Thermal(..) => 0.0,
            ImuQuantity::Of(SensorKind::Accelerometer, _) | ImuQuantity::GSensitivity(..) => {
                let power = match quantity {
                    ImuQuantity::Of(_, Quantity::Nonlinear(term, _)) => f64::from(term.power() - 1),
                    _ => 1.0,
                };
                -power * quantity.value(imu) / gravity.magnitude_mps2
            }
        }),
    )
}

/// The words for a gravity as a source of shared errors: another calibration that states the same has the same error where its place is the same.
#[must_use]
pub fn gravity_source(gravity: &Gravity) -> String {
    format!("gravity {} ± {} m/s²", gravity.magnitude_mps2, gravity.sd_mps2)
}

/// Does a source say by itself which place it is of? Gravity does where somebody stated it or its latitude; the default is that of any place.
#[must_use]
pub fn tells_its_place(source: &str) -> bool {
    source.starts_with("gravity ") && source != gravity_source(&Gravity::SOMEWHERE)
}

/// What an unknown error of gravity does to a calibration against gravity at rest: all calibrations at one place have it. `None` where gravity is exact.
///
/// `prior_share`: the share of each quantity's information that comes from a prior; empty without any. It stands for `Σ W` where no more than the shares
/// is written.
#[must_use]
pub fn shared_gravity(
    quantities: &[ImuQuantity],
    prior_share: &[f64],
    imu: &ImuParameters,
    gravity: &Gravity,
) -> Option<SharedErrors> {
    let of_data = |k: usize| 1.0 - prior_share.get(k).copied().unwrap_or(0.0);
    let slope = slope_of_data(quantities, imu, gravity);
    let column = DVector::from_fn(slope.len(), |k, _| slope[k] * of_data(k)) * gravity.sd_mps2;
    SharedErrors::of_source(gravity_source(gravity), column.as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{NonlinearTerm, ParameterList};
    use nalgebra::{Matrix3, Vector3};

    /// With gravity a little larger, forces are, and moved parameters give the same readings at every temperature.
    #[test]
    fn readings_stay_when_gravity_and_parameters_move_together() {
        let quantities = [
            ImuQuantity::full_list(true, true, true),
            ImuQuantity::thermal_list(SensorKind::Accelerometer, 2, 2),
            ImuQuantity::thermal_list(SensorKind::Gyroscope, 2, 2),
            ParameterList::from_quantities(Vec::new()).with_terms(&NonlinearTerm::ALL).of_accelerometer(),
        ]
        .concat();
        let mut imu = ImuParameters::identity();
        imu.g_sensitivity = Matrix3::repeat(1e-3);
        for (k, quantity) in quantities.iter().enumerate() {
            quantity.add_to(&mut imu, 1e-3 * (k as f64 + 1.0).sin());
        }
        let gravity = Gravity { magnitude_mps2: 9.8, sd_mps2: 0.0 };
        let share = 1e-6;
        let mut moved = imu;
        let slope = slope_of_data(&quantities, &imu, &gravity);
        for (quantity, slope) in quantities.iter().zip(slope.iter()) {
            quantity.add_to(&mut moved, slope * share * gravity.magnitude_mps2);
        }
        let (force, rate) = (Vector3::new(3.0, -5.0, 7.0), Vector3::new(0.3, 0.2, -0.1));
        for temperature_c in [5.0, 60.0] {
            let read = |imu: &ImuParameters, force: Vector3<f64>| {
                let imu = imu.at(temperature_c);
                (
                    imu[SensorKind::Accelerometer].reading(&force),
                    imu[SensorKind::Gyroscope].reading(&rate) + imu.g_sensitivity * force,
                )
            };
            let (one, other) = (read(&imu, force), read(&moved, force * (1.0 + share)));
            assert!((one.0 - other.0).amax() < 1e-9 && (one.1 - other.1).amax() < 1e-9, "{one:?} {other:?}");
        }
    }
}
