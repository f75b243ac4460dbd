//! What is to be calibrated on a machine, and its unknowns in their order.

pub(crate) mod layout;
pub(crate) mod machine_problem;
pub(crate) mod parameters;
pub(crate) mod quantity;
pub(crate) mod setup;
pub(crate) mod unsolved;
