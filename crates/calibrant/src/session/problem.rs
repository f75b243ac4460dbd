//! The sensors, their recording and what is known of it, for every kind of calibration.

use super::noise::{NoiseInHold, calibrated_with_noise};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, FacesProblem, ImuProblem, Stimulus, Validation,
    calibrate, calibrate_faces, calibrate_imu_with, cross_validate, cross_validate_imu, validate,
    validate_imu,
};

/// The problem of an estimator.
pub(crate) enum Problem<'a> {
    Accelerometer(CalibrationProblem<'a>),
    Faces(FacesProblem<'a>),
    Imu(ImuProblem<'a>),
}

impl Problem<'_> {
    /// The calibration, and beside it the noise of an IMU in its longest hold; that of the accelerometer only for a report.
    pub(crate) fn calibrate(
        &self,
        settings: &CalibrationSettings,
        report: bool,
    ) -> (Result<Calibration>, NoiseInHold) {
        match self {
            Self::Accelerometer(problem) => (calibrate(problem, settings), NoiseInHold::default()),
            Self::Faces(problem) => (calibrate_faces(problem, settings), NoiseInHold::default()),
            Self::Imu(problem) => {
                calibrated_with_noise(problem.recording, &problem.setup.holds, report, |white_noise| {
                    calibrate_imu_with(problem, settings, white_noise)
                })
            }
        }
    }

    /// The errors of a calibration on this recording.
    pub(crate) fn validate(&self, calibration: &Calibration) -> Result<Validation> {
        match self {
            Self::Accelerometer(problem) => validate(calibration, problem),
            Self::Faces(FacesProblem { sensor, recording, holds, .. }) => {
                let stimulus = Stimulus::Holds(holds);
                validate(calibration, &CalibrationProblem { sensor, recording, stimulus })
            }
            Self::Imu(problem) => validate_imu(calibration, problem),
        }
    }

    /// The errors on blocks of holds, each by a calibration without it.
    pub(crate) fn cross_validate(
        &self,
        calibration: &Calibration,
        settings: &CalibrationSettings,
        folds: usize,
    ) -> Result<Validation> {
        match self {
            Self::Accelerometer(problem) => cross_validate(calibration, problem, settings, folds),
            Self::Faces(_) => Err(Error::experiment(InputError::new(
                Refusal::ValidationImpossible,
                "folds say nothing where the directions of the holds are known: a face that is left out shows how well the sensor was placed on it",
                "validate on another recording, with holds in any orientation",
            ))),
            Self::Imu(problem) => cross_validate_imu(calibration, problem, settings, folds),
        }
    }
}
