//! The least squares of the holds, for given weights: an IMU without a gyroscope.

use crate::estimate::CalibrationSettings;
use crate::estimate::imu::{ImuModel, State};
use crate::sensor::{Correction, ImuParameters, SensorKind, SensorParameters};
use crate::solve::{CalibrationStatus, LoopSettings};
use nalgebra::{DMatrix, DVector, Vector3};

/// Where the iteration ended.
pub(super) struct Fit {
    pub(super) sensor: SensorParameters,
    pub(super) forces: Vec<Vector3<f64>>,
    pub(super) information: DMatrix<f64>,
    /// Diagonal of the information before the directions were eliminated.
    pub(super) unreduced: DVector<f64>,
    /// That of the data and of the prior.
    pub(super) chi2: f64,
    pub(super) prior_chi2: f64,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

/// The force of each mean reading that the sensor's correction gives, scaled to gravity.
pub(super) fn forces(
    means: impl Iterator<Item = Vector3<f64>>,
    sensor: &SensorParameters,
    gravity: f64,
) -> Option<Vec<Vector3<f64>>> {
    let correction = Correction::of(sensor)?;
    means.map(|mean| Some(correction.apply(&mean).try_normalize(1e-300)? * gravity)).collect()
}

/// Iterates from a sensor; `None` where its matrix is singular.
pub(super) fn iterate(
    model: &ImuModel<'_>,
    start: &SensorParameters,
    settings: &CalibrationSettings,
) -> Option<Fit> {
    let means = model.holds.iter().map(|hold| hold.accelerometer);
    let forces = forces(means, start, model.gravity)?;
    let imu = ImuParameters::identity().with(SensorKind::Accelerometer, *start);
    let rounding = rounding(model);
    let settings = LoopSettings {
        most: settings.max_iterations,
        tolerance: settings.tolerance,
        rounding: &[(rounding, 1)],
        untested_below: rounding,
        least_chi2: 0.0,
        damping: [1e-4, 1e14],
        has_last_step: true,
    };
    let end = model.minimise((State { imu, forces }, Vec::new()), &settings)?;
    Some(Fit {
        prior_chi2: model.prior_chi2(&end.state),
        sensor: end.state.imu[SensorKind::Accelerometer],
        forces: end.state.forces,
        information: end.information,
        unreduced: end.unreduced,
        chi2: end.chi2,
        status: end.status,
        iterations: end.iterations,
        gradient_norm: end.gradient_norm,
    })
}

/// A step below this many standard deviations may be rounding. For nearly exact data that is the rounding of the means themselves.
fn rounding(model: &ImuModel<'_>) -> f64 {
    let square = |mean: &Vector3<f64>, weight| mean.dot(&(weight * mean));
    let squares: f64 =
        model.holds.iter().map(|hold| square(&hold.accelerometer, hold.accelerometer_weight)).sum();
    (8.0 * f64::EPSILON * squares.sqrt()).max(1e-6)
}
