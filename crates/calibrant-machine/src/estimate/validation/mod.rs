//! Validation by blocks of time, and on another recording.

pub(crate) mod cross_validation;
pub(crate) mod machine_validation;
pub(crate) mod second_recording;
pub(crate) mod shift;
