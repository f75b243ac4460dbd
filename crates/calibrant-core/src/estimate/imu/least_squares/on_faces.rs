//! The least squares of an accelerometer where all directions are known: the readings are linear in its parameters, but for terms that bend the response.

use crate::estimate::imu::model::{Fit, ImuModel, State};
use crate::estimate::settings::CalibrationSettings;
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, SensorKind, SensorParameters};
use nalgebra::{DMatrix, Vector3};

/// Steps that are exact where terms bend the response.
const STEPS_OF_BENT: usize = 6;

impl ImuModel<'_> {
    /// The sensor. `None` if a matrix is singular. No step is refused: wrong directions may give a mirrored sensor.
    pub(crate) fn sensor_on_faces(&self) -> Option<SensorParameters> {
        let bends = |of: &ImuQuantity| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(..)));
        let steps = if self.quantities.iter().any(bends) { STEPS_OF_BENT } else { 1 };
        let mut state = self.on_faces(&SensorParameters::identity());
        for _ in 0..steps {
            let step = self.step(&state, &[])?;
            for (quantity, step) in self.quantities.iter().zip(step.iter()) {
                quantity.add_to(&mut state.imu, *step);
            }
        }
        Some(state.imu[SensorKind::Accelerometer])
    }

    /// The problem linearised at a sensor. `None` if a matrix is singular.
    pub(crate) fn linearised_on_faces(&self, at: &SensorParameters) -> Option<Fit> {
        self.linearised(&self.on_faces(at), &CalibrationSettings::default()).ok()
    }

    /// The information about a sensor.
    pub(crate) fn information_on_faces(&self, at: &SensorParameters) -> Option<DMatrix<f64>> {
        Some(self.linearised_on_faces(at)?.information)
    }

    fn on_faces(&self, sensor: &SensorParameters) -> State {
        let forces = self.holds.iter().map(|hold| hold.known.unwrap_or_else(Vector3::zeros)).collect();
        State { imu: ImuParameters::identity().with(SensorKind::Accelerometer, *sensor), forces }
    }
}
