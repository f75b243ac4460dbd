//! Calibrates a sensor that a machine carries.

mod begin;
mod calibrate;
mod covariance;
mod least_squares;
mod noise;
mod problem;
mod result;
mod validation;

pub(crate) use begin::reference_fit::{ReferenceFit, fitted};
pub use calibrate::calibrate_on_machine;
pub use problem::machine_problem::{MachineProblem, MachineSettings};
pub use problem::parameters::MachineParameters;
pub(crate) use problem::parameters::TiltedGravity;
pub use problem::quantity::{MachineQuantity, Source};
pub use problem::setup::{MachineSetup, MachineTrust, MountingPrior};
pub use result::machine_calibration::{BudgetRow, MachineCalibration, ReferenceNoise, SensorResidual};
pub use result::spectrum::ResidualSpectrum;
pub use validation::cross_validation::{check_folds, cross_validate_on_machine};
pub use validation::machine_validation::{
    FailedBlock, LargestShift, MachineValidation, MachineValidationSource, ParameterShift,
};
pub use validation::second_recording::compare_on_machine;
