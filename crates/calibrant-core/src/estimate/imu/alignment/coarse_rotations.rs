//! Coarse rotations with few samples, for a rough test of the gyroscope's matrix.

use crate::estimate::holds::median;
use crate::estimate::imu::least_squares::integration::propagated_back;
use crate::estimate::imu::model::{ImuModel, RotationData, State};
use crate::sensor::SensorKind;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Units or axes are wrong if the median rotation error exceeds this, rad.
pub(crate) const WRONG_RAD: f64 = 0.2;

/// Approximate number of samples of a coarse rotation.
const COARSE_SAMPLES: usize = 150;

/// The rotation errors for one matrix of the gyroscope.
pub(crate) struct Judged {
    /// Median of the angles, rad.
    pub(crate) median_rad: f64,
    /// Number of rotation errors beyond a right angle.
    pub(crate) upside_down: usize,
}

/// The coarse rotations.
pub(crate) struct CoarseRotations {
    rotations: Vec<ThinnedRotation>,
}

/// A coarse rotation, with gravity before and after it.
struct ThinnedRotation {
    turns: Vec<Vector3<f64>>,
    from: Vector3<f64>,
    to: Vector3<f64>,
}

impl CoarseRotations {
    /// The coarse rotations at the bias of a state. Its gains do not matter.
    pub(crate) fn of(model: &ImuModel<'_>, state: &State) -> Self {
        let used = model.rotations.iter().filter(|data| data.used);
        let cut_down = |data: &RotationData<'_>| {
            let step = data.samples.times_s.len().div_ceil(COARSE_SAMPLES);
            let bias = state.imu.at(data.samples.temperature_c())[SensorKind::Gyroscope].bias;
            ThinnedRotation {
                turns: data.samples.cut_down(&bias, step),
                from: state.forces[data.from],
                to: state.forces[data.from + 1],
            }
        };
        Self { rotations: used.map(cut_down).collect() }
    }

    /// Number of rotations.
    pub(crate) fn len(&self) -> usize {
        self.rotations.len()
    }

    /// Rotation errors for a matrix of the gyroscope. `None` for a singular matrix, or without rotations.
    pub(crate) fn judge(&self, matrix: &Matrix3<f64>) -> Option<Judged> {
        let correction = matrix.try_inverse()?;
        let error = |rotation: &ThinnedRotation| {
            propagated_back(&rotation.turns, &correction, &rotation.from).angle(&rotation.to)
        };
        let errors: Vec<f64> = self.rotations.iter().map(error).collect();
        let upside_down = errors.iter().filter(|error| **error > FRAC_PI_2).count();
        (!errors.is_empty()).then(|| Judged { median_rad: median(errors), upside_down })
    }
}
