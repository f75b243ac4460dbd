//! The results of commands, as they are written and read back.

pub(crate) mod batch;
pub(crate) mod calibration;
pub(crate) mod campaign;
pub(crate) mod campaign_calibration;
pub(crate) mod comparison;
pub(crate) mod design;
pub(crate) mod earlier_calibration;
pub(crate) mod earlier_machine;
pub(crate) mod exact_number;
pub(crate) mod heading;
pub(crate) mod input;
pub(crate) mod json;
pub(crate) mod judgement;
pub(crate) mod machine_calibration;
pub(crate) mod machine_validation;
pub(crate) mod noise;
pub(crate) mod origin;
pub(crate) mod pose_design;
pub(crate) mod reach;
pub(crate) mod recorded_campaign;
#[cfg(feature = "study")]
pub(crate) mod study;
pub(crate) mod summary;
pub(crate) mod sweep;
pub(crate) mod trajectory_design;
pub(crate) mod trajectory_sweep;
