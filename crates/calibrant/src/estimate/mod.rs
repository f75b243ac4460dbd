//! From a recording to parameters with an honest covariance.

mod result;

pub use result::*;
