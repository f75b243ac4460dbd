//! `truth.json`: the true values of a simulation.

pub(crate) mod machine;
pub(crate) mod parameter;
pub(crate) mod sensors;
