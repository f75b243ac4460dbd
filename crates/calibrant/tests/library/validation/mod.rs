//! Calibrations on data that were not used for them.

mod bench;
mod duplicate_recording;
mod errors;
mod explanations;
mod ferraris;
mod noise;
mod real;
mod refused_inputs;
mod significance_levels;
