//! The movements between the stationary intervals: rotations, and turns of known angle.

use crate::diagnostic::RotationReason;
use crate::error::Result;
use crate::estimate::imu::model::{GyroscopeNoise, HoldData, RotationData, TurnData};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::rotations::felt_force::interpolated_forces;
use crate::estimate::imu::rotations::gravity_at_ends::{AtEnds, TurnsInHolds, gravity_at_ends};
use crate::estimate::imu::rotations::spans::{Integrable, Span, rotation_spans};
use crate::estimate::imu::rotations::turns::turn_data;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::motion::Hold;
use crate::sensor::{ImuParameters, Recording, SensorKind, SensorParameters};
use nalgebra::Vector3;

/// The recording between the used holds.
pub(crate) struct Movement<'a> {
    pub(crate) spans: Vec<Span>,
    pub(crate) integrable: Integrable<'a>,
    /// Specific force at the gyroscope's times, if turns or the g-sensitivity need it.
    forces: Option<Vec<Vector3<f64>>>,
    /// Gravity at the ends of the holds.
    at_ends: Vec<AtEnds>,
    pub(crate) turns_in_holds: TurnsInHolds,
    /// Does the gyroscope have a g-sensitivity?
    feels: bool,
}

impl<'a> Movement<'a> {
    /// `accelerometer`: the estimate from the holds alone, at the reference temperature.
    pub(crate) fn of(
        problem: &ImuProblem<'a>,
        (accelerometer, sensor): (&Recording, &SensorParameters),
        gyroscope: &'a Recording,
        holds: &[&Hold],
    ) -> Self {
        let setup = problem.setup;
        let feels = problem.gyroscope.g_sensitivity;
        let needs_forces = feels || !setup.turns.is_empty();
        let forces = needs_forces.then(|| interpolated_forces(accelerometer, gyroscope, sensor)).flatten();
        let spans = match setup.directions {
            // the sensor was put on each face anew: the movements in between determine less than the turns
            Some(_) if !setup.turns.is_empty() => Vec::new(),
            _ => rotation_spans(gyroscope, holds, &setup.holds.further_from_s),
        };
        let (at_ends, turns_in_holds) = gravity_at_ends(accelerometer, sensor, holds, None);
        let as_read = problem.recording[SensorKind::Accelerometer].as_ref().filter(|_| feels);
        Self { spans, integrable: Integrable::of(gyroscope, as_read), forces, at_ends, turns_in_holds, feels }
    }

    /// The rotations, each from one of the holds to the next.
    pub(crate) fn rotations(&self, holds: &[HoldData]) -> Vec<RotationData<'_>> {
        let felt = self.forces.as_deref().filter(|_| self.feels);
        self.integrable.rotations(felt, &self.spans, (holds, &self.at_ends))
    }

    /// The turns of known angle. `start`: the initial IMU, and the temperatures.
    pub(crate) fn turns(
        &self,
        problem: &ImuProblem<'_>,
        noise: &GyroscopeNoise,
        start: (&ImuParameters, &RecordingTemperature<'_>),
    ) -> Result<Vec<TurnData>> {
        turn_data(problem, &self.integrable, noise, self.forces.as_deref(), start)
    }

    /// The rotations that cannot be integrated, with the reason.
    pub(crate) fn obstacles(&self) -> Vec<RotationReason> {
        let rotations = self.spans.iter().filter(|span| !span.is_between_recordings);
        rotations.filter_map(|span| self.integrable.obstacle(span)).collect()
    }
}
