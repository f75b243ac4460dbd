//! Tests of validation: calibrations on data that they did not use.

mod bench;
mod errors;
mod explanations;
mod ferraris;
mod noise;
mod real;
mod refused_inputs;
mod significance_levels;
mod verdicts;
