//! What is to be calibrated on a machine, and its unknowns in their order.

mod machine_problem;
mod parameters;
mod quantity;
mod work;

pub use machine_problem::{MachineProblem, MachineSettings, MachineSetup, MachineTrust, MountingPrior};
pub(crate) use machine_problem::{refused, unsolved};
pub use parameters::{Layout, MachineParameters, TiltedGravity};
pub use quantity::MachineQuantity;
