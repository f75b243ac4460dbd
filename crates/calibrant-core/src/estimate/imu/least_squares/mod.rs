//! The least squares of all: rotations integrated, residuals with their derivatives, and Gauss–Newton on the bordered chain.

pub(crate) mod arc;
pub(crate) mod earth;
pub(crate) mod gauss_newton;
pub(crate) mod integration;
pub(crate) mod rates;
pub(crate) mod residuals;
