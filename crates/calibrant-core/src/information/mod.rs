//! Fisher information and covariance of the parameters, the criteria of optimality, and what the data leave undetermined.

pub(crate) mod chain_model;
mod covariance;
pub mod criterion;
mod expected_information;
mod identifiability;
mod motion_information;
mod undetermined_explanation;

pub use covariance::covariance;
pub use criterion::Criterion;
pub use expected_information::MotionInformation;
pub use identifiability::{Undetermined, undetermined};
pub use motion_information::{InformationDerivative, Linearised, PartInformation};
pub use undetermined_explanation::{MotionFacts, View, explain};
