//! The least-squares problem, its normal equations, and the steps that solve it.

pub(crate) mod equations;
pub(crate) mod front;
pub(crate) mod gauss_newton;
pub(crate) mod log_equations;
pub(crate) mod model;
pub(crate) mod moments;
pub(crate) mod pass;
pub(crate) mod robust;
pub(crate) mod sample_rows;
pub(crate) mod scaled;
pub(crate) mod stream;

#[cfg(test)]
mod derivative_tests;
