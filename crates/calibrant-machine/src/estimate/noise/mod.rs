//! The noise of sensors and log, from the residuals.

mod noise_search;
mod posterior;

pub(crate) use noise_search::{Activity, Growths, noise_search};
pub(crate) use posterior::{Posterior, Sums};
