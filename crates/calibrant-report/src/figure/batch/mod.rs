//! Figures of a batch of sensors.

mod drift;
mod groups;
mod histogram;
mod pareto;
mod reach;

pub(crate) use drift::{SENSORS, drifts};
pub(crate) use histogram::parameter_histograms;
pub(crate) use pareto::code_bars;
