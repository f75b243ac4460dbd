//! What is in a file, before anything is calibrated from it.

pub(crate) mod recording;
pub(crate) mod reference_log;
pub(crate) mod sampling;
