//! What a calibration gives: parameters, residuals, checks, and what the motion does not determine.

pub(crate) mod assembly;
pub(crate) mod checks;
pub(crate) mod machine_calibration;
pub(crate) mod spectrum;
pub(crate) mod undetermined;
