//! Calibrations on data that were not used for them.

mod bench;
mod errors;
mod ferraris;
mod levels;
mod noise;
mod real;
mod reasons;
mod refused;
mod same;
