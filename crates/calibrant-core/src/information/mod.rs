//! Fisher information and covariance of the parameters, criteria of optimality, and undetermined parameters.
//! It uses the sensor, the motion and the arrowhead.

pub(crate) mod chain_model;
mod clock_marginal;
mod clock_response;
pub mod criterion;
mod expected_information;
pub(crate) mod gravity_marginal;
mod identifiability;
mod motion_information;
mod second_derivative;
mod undetermined_explanation;

pub(crate) use clock_response::with_known_clock;
pub use criterion::Criterion;
pub use expected_information::MotionInformation;
pub(crate) use expected_information::spread;
pub use gravity_marginal::{GravityMarginal, with_biases};
pub use identifiability::{Undetermined, covariance, undetermined};
pub use motion_information::{InformationDerivative, Linearised, PartInformation};
pub use second_derivative::InformationCurvature;
pub use undetermined_explanation::{MotionFacts, View, explain};
