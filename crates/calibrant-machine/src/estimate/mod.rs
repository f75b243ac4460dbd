//! Calibrates a sensor that a machine carries.

mod begin;
mod calibrate;
mod covariance;
#[cfg(test)]
mod flexure_tests;
#[cfg(test)]
mod hard_log_tests;
mod least_squares;
#[cfg(test)]
mod mistake_tests;
mod mount_variance;
mod noise;
mod problem;
mod result;
mod validation;

pub use begin::MotionOfLog;
pub(crate) use begin::fitted;
pub use calibrate::calibrate_on_machine;
pub(crate) use least_squares::predicted;
pub use mount_variance::{MountVariance, mount_variances};
pub use problem::{
    Layout, MachineParameters, MachineProblem, MachineQuantity, MachineSettings, MachineSetup, MachineTrust,
    MountingPrior, TiltedGravity,
};
pub use result::{
    MachineCalibration, ReferenceNoise, ResidualSpectrum, SampleResidual, SensorDrift, SensorResidual,
};
pub use validation::{
    FailedBlock, LargestShift, MachineValidation, MachineValidationSource, ParameterShift, check_folds,
    compare_on_machine, cross_validate_on_machine,
};
