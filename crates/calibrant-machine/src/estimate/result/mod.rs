//! What a calibration gives: parameters, residuals, checks, and what the motion does not determine.

mod assembly;
pub(crate) mod checks;
mod drift;
pub(crate) mod flexure;
mod machine_calibration;
pub(crate) mod plausible;
mod sample_residual;
mod separability;
mod shared_errors;
mod spectrum;
pub(crate) mod undetermined;
mod unseen_mount;

pub(crate) use assembly::assembled;
pub use drift::SensorDrift;
pub use machine_calibration::{MachineCalibration, ReferenceNoise, SensorResidual};
pub use sample_residual::SampleResidual;
pub use spectrum::ResidualSpectrum;
