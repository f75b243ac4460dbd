//! Fisher information and covariance of the parameters, the criteria of optimality, and what the data leave undetermined.

pub(crate) mod chain_model;
mod covariance;
pub mod criterion;
mod expected;
mod explanation;
mod identifiability;
mod part;

pub use covariance::covariance;
pub use criterion::Criterion;
pub use expected::MotionInformation;
pub use explanation::{MotionFacts, View, explain};
pub use identifiability::{Undetermined, undetermined};
pub use part::{InformationDerivative, Linearised, PartInformation};
