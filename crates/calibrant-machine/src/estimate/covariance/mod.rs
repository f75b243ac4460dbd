//! What the covariance says beyond the inverse of the information.

pub(crate) mod budget;
pub(crate) mod sandwich;
pub(crate) mod second_order;
