//! The accelerometer's mean in a hold: `ȳ_a − S_a f_j − b_a`, at the temperature of the hold.

use crate::estimate::imu::model::ImuModel;
use crate::estimate::imu::terms::term::{At, Derivatives, Place, Residual, Term, Weight, by_quantities};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::{Condition, SensorKind};

#[derive(Debug)]
pub(crate) struct HoldForce;

impl Term for HoldForce {
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
        let (hold, force) = (&at.model.holds[k], &at.state.forces[k]);
        let accelerometer = at.state.imu.sensor_at(SensorKind::Accelerometer, hold.temperature_c);
        Some(Residual {
            r: hold.accelerometer - accelerometer.reading(force),
            weight: Weight::Full(hold.accelerometer_weight),
        })
    }

    fn derivatives(&self, at: &At<'_>, k: usize) -> Derivatives {
        let (force, temperature_c) = (at.state.forces[k], at.model.holds[k].temperature_c);
        let accelerometer = at.state.imu.sensor_at(SensorKind::Accelerometer, temperature_c);
        let by_force = accelerometer.by_stimulus(&force);
        let felt = Condition { imu: &at.state.imu, stimulus: force, force, temperature_c };
        Derivatives {
            by_directions: [None, Some(by_force * (tangents(&force) * at.model.gravity))],
            by_quantities: by_quantities(at.model, SensorKind::Accelerometer, |of| of.derivative(&felt)),
        }
    }
}
