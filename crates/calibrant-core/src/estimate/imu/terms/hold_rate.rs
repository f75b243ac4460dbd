//! The gyroscope's mean in a hold: `ȳ_g − b_g − Γ f_j − S_g ω_j`, at the temperature of the hold.
//!
//! `ω_j = κ f_j + E_j h` is the Earth's rate (`earth_rate`). It is fixed in the least squares, and estimated with the weights.

use crate::estimate::imu::model::ImuModel;
use crate::estimate::imu::terms::term::{At, Derivatives, Place, Residual, Term, Weight, by_quantities};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::{Condition, ImuParameters, ImuQuantity, SensorKind};
use nalgebra::{Matrix3xX, Vector3};

#[derive(Debug)]
pub(crate) struct HoldRate;

impl ImuModel<'_> {
    /// The gyroscope's reading in a hold, at the temperature of the IMU.
    pub(crate) fn at_rest(&self, hold: usize, imu: &ImuParameters, force: &Vector3<f64>) -> Vector3<f64> {
        imu[SensorKind::Gyroscope].reading(&self.earth.rate(hold, force)) + imu.g_sensitivity * force
    }
}

impl Term for HoldRate {
    fn rows(&self) -> usize {
        3
    }

    fn place(&self) -> Place {
        Place::Hold
    }

    fn count(&self, model: &ImuModel<'_>) -> usize {
        model.holds.len()
    }

    fn residual(&self, at: &At<'_>, k: usize) -> Option<Residual> {
        let hold = &at.model.holds[k];
        let (mean, weight) = hold.gyroscope?;
        let imu = at.state.imu.at(hold.temperature_c);
        let r = mean - at.model.at_rest(k, &imu, &at.state.forces[k]);
        Some(Residual { r, weight: Weight::Rows(weight) })
    }

    fn derivatives(&self, at: &At<'_>, k: usize) -> Derivatives {
        let (model, force, temperature_c) = (at.model, at.state.forces[k], at.model.holds[k].temperature_c);
        let imu = at.state.imu.at(temperature_c);
        let by_force = imu.g_sensitivity + imu[SensorKind::Gyroscope].matrix * model.earth.vertical_rate();
        let still =
            Condition { imu: &at.state.imu, stimulus: model.earth.rate(k, &force), force, temperature_c };
        Derivatives {
            by_directions: [None, Some(by_force * (tangents(&force) * model.gravity))],
            by_quantities: by_quantities(model, SensorKind::Gyroscope, |of| of.derivative(&still)),
        }
    }

    fn by_earth(&self, at: &At<'_>, k: usize) -> Matrix3xX<f64> {
        let imu = at.state.imu.at(at.model.holds[k].temperature_c);
        at.model.earth.of_hold(k, &imu, &at.state.forces[k])
    }

    /// What the Earth's rate says of gains is nothing beside rotations and turns.
    fn tells(&self, _: &ImuModel<'_>, quantity: ImuQuantity, _: &ImuParameters) -> bool {
        quantity.is_of_bias() || matches!(quantity, ImuQuantity::GSensitivity(..))
    }
}
