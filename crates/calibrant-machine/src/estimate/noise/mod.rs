//! The noise of sensors and log, from the residuals.

pub(crate) mod activity;
pub(crate) mod noise_search;
pub(crate) mod posterior;
