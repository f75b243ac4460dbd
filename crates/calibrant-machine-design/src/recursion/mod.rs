//! What a sensor on the chain feels, and derivatives of any function of it with respect to the joints.

mod links;
mod number;
mod sweep;
#[cfg(test)]
mod tests;
mod vector;

pub(crate) use links::{FixedStep, Links};
pub(crate) use number::{Dual, Number, Six};
pub(crate) use sweep::{JointAt, JointBars, Moving, Sweep};
pub(crate) use vector::{M, V};
