//! The initial values of the accelerometer, from its readings alone.

use crate::diagnostic::Diagnostic;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::hold_variance::{between_variance, noise_variance};
use crate::estimate::imu::initial::face_alignment::{FaceAlignment, FaceScatter};
use crate::estimate::imu::initial::face_repeats::FaceRepeats;
use crate::motion::Hold;
use crate::sensor::{Recording, SensorParameters, SensorThermal};
use nalgebra::{Matrix3, Vector3};

/// Least noise of a face's mean, m/s². Readings without noise are still rounded to their last digit.
const LEAST_NOISE_MPS2: f64 = 3e-8;

/// The initial accelerometer.
pub(crate) struct InitialAccelerometer {
    pub(crate) sensor: SensorParameters,
    /// Standard deviation of a sample within holds.
    pub(crate) within: Vector3<f64>,
    /// Variance of a hold's mean that does not depend on its number of samples.
    pub(crate) of_mean: Vector3<f64>,
    pub(crate) holds: HoldCalibration,
    /// How well the sensor was placed on the faces, where the directions are known.
    pub(crate) alignment: Option<FaceAlignment>,
    /// How often each face was held.
    pub(crate) repeats: FaceRepeats,
    pub(crate) warnings: Vec<Diagnostic>,
    /// Its temperature terms, if they were fitted, and the recording converted to the reference temperature.
    pub(crate) thermal: SensorThermal,
    pub(crate) adjusted: Option<Recording>,
}

impl InitialAccelerometer {
    /// Inverse covariance of a hold's mean, for a scatter between holds in m/s².
    pub(crate) fn weight(&self, hold: &Hold, between: f64) -> Matrix3<f64> {
        let variance = noise_variance(hold, &self.within, &self.of_mean)
            + between_variance(between, &self.sensor.matrix);
        Matrix3::from_diagonal(&variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)))
    }

    /// Inverse covariance of the mean of a hold on a face, beside the others on it.
    pub(crate) fn weight_on_face(
        &self,
        hold: &Hold,
        force: &Vector3<f64>,
        scatter: &FaceScatter,
    ) -> Matrix3<f64> {
        self.weight_by(hold, force, &self.repeats.of_hold(scatter, force))
    }

    /// Inverse covariance of the mean of a hold, with this one of its force.
    pub(crate) fn weight_by(
        &self,
        hold: &Hold,
        force: &Vector3<f64>,
        covariance: &Matrix3<f64>,
    ) -> Matrix3<f64> {
        inverse_covariance(
            &noise_variance(hold, &self.within, &self.of_mean),
            &self.sensor.by_stimulus(force),
            covariance,
        )
    }
}

/// The inverse of `diag(variance) + S C Sᵀ`.
pub(crate) fn inverse_covariance(
    variance: &Vector3<f64>,
    s: &Matrix3<f64>,
    c: &Matrix3<f64>,
) -> Matrix3<f64> {
    let least = LEAST_NOISE_MPS2.powi(2) * s.norm_squared() / 3.0;
    let variance = variance.map(|variance| variance.max(least));
    (Matrix3::from_diagonal(&variance) + s * c * s.transpose()).try_inverse().unwrap_or_else(Matrix3::zeros)
}

/// The holds that are used.
pub(crate) struct UsedHolds<'a> {
    /// Their numbers, from 0.
    pub(crate) numbers: Vec<usize>,
    pub(crate) holds: Vec<&'a Hold>,
    /// Specific force in each, in the frame of the accelerometer, m/s².
    pub(crate) forces: Vec<Vector3<f64>>,
}

impl InitialAccelerometer {
    /// The used holds.
    pub(crate) fn used_holds(&self) -> UsedHolds<'_> {
        let all = &self.holds.holds;
        let numbers: Vec<usize> = (0..all.len()).filter(|&j| all[j].used).collect();
        let along = self.alignment.map_or(1.0, |alignment| alignment.cosine());
        UsedHolds {
            forces: numbers.iter().map(|&j| all[j].force_mps2 * along).collect(),
            holds: numbers.iter().map(|&j| &all[j].hold).collect(),
            numbers,
        }
    }
}
