//! Calibrates a sensor that a machine carries.

mod activity;
mod assembly;
mod budget;
mod calibrate;
mod checks;
mod covered;
#[cfg(test)]
mod derivative_tests;
mod equations;
mod front;
mod gauss_newton;
mod initial;
mod knot_choice;
mod layout;
mod log_equations;
mod model;
mod moments;
mod noise_search;
mod parameters;
mod pass;
mod posterior;
mod problem;
mod quantity;
mod reference_fit;
mod result;
mod robust;
mod sample_rows;
mod sandwich;
mod scaled;
mod setup;
mod spectrum;
mod start;
mod stream;
mod trusted;
mod undetermined;
mod unsolved;

pub use calibrate::calibrate_on_machine;
pub use parameters::MachineParameters;
pub(crate) use parameters::TiltedGravity;
pub use problem::{MachineProblem, MachineSettings};
pub use quantity::{MachineQuantity, Source};
pub(crate) use reference_fit::{ReferenceFit, fitted};
pub use result::{BudgetRow, MachineCalibration, ReferenceNoise, SensorResidual};
pub use setup::{MachineSetup, MachineTrust, MountingPrior};
pub use spectrum::ResidualSpectrum;
