//! Fisher information and covariance of the parameters, and what the data leave undetermined.

mod covariance;
mod identifiability;

pub use covariance::covariance;
pub use identifiability::{Undetermined, undetermined};
