//! Calibrates a sensor that a machine carries.

mod calibrate;
mod covered;
mod front;
mod gauss_newton;
mod layout;
mod log_equations;
mod model;
mod parameters;
mod posterior;
mod quantity;
mod reference_fit;
mod robust;
mod sample_rows;
mod setup;
mod start;
mod stream;

pub use calibrate::explore;
pub use parameters::MachineParameters;
pub use quantity::{MachineQuantity, Source};
pub use setup::{MachineSetup, MachineTrust, MountingPrior};
