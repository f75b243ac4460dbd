//! The mathematics of calibrant: sensor models, estimation, noise analysis and simulation. It reads no files
//! and prints nothing.
//!
//! Data flow one way: [`sensor`] and [`motion`] say what is measured. [`arrowhead`] is the one linear-algebra
//! kernel. [`information`] turns its result into a covariance, and explains what is undetermined.
//! [`noise`] examines a sensor at rest, by [`fourier`] too. `solve` has the least squares that estimates share. [`estimate`] calibrates.
//! What a user should know of a result is a [`diagnostic`]. [`acceptance`] compares it with limits. [`simulate`] makes sensors and
//! recordings. [`budget`] says what work takes, [`progress`] how far it is, and [`interruption`] ends it early. [`number_format`] writes
//! numbers for people, [`json`] and [`form`] results for programs.
//!
//! The crate `calibrant` re-exports all of it. Depend on that crate unless the build time matters.

pub mod acceptance;
pub mod arrowhead;
pub mod budget;
pub mod diagnostic;
pub mod error;
pub mod estimate;
pub mod form;
pub mod fourier;
pub mod information;
pub mod interruption;
pub mod json;
pub mod motion;
pub mod noise;
pub mod number_format;
pub mod progress;
mod root;
pub mod sensor;
pub mod simulate;
mod solve;

pub use error::{Error, Result};
