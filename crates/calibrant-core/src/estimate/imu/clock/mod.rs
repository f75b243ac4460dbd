//! The gyroscope's clock beside the accelerometer's.

pub(crate) mod difference;
pub(crate) mod offset;
pub(crate) mod rate;
