//! Places of results, and what a batch keeps of them.

pub(crate) mod finished;
pub(crate) mod name_pattern;
pub(crate) mod result_places;
pub(crate) mod resume_key;
pub(crate) mod sensor_naming;
