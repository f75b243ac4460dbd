//! What a sensor on the chain feels, and derivatives of any function of it with respect to the joints.

mod contraction;
mod links;
mod sweep;
#[cfg(test)]
mod tests;
mod vector;

pub(crate) use contraction::Contraction;
pub(crate) use links::Links;
pub(crate) use sweep::{JointAt, JointBars, Moving, Sweep, carried};
pub(crate) use vector::{M, V};
