//! The experiments over many sensors.

mod result;

pub use result::*;
