//! Stationary intervals of both sensors, and the gyroscope's means in them.

pub(crate) mod gyroscope;
pub(crate) mod intervals;
pub(crate) mod motion;
pub(crate) mod scatter;
