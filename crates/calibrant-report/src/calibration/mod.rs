//! The sheet of one calibration, of an accelerometer alone or of a whole IMU.

mod axes;
mod before_after;
mod correction;
mod fit;
mod holds;
mod motion;
mod page;
mod parameters;
mod quality;
mod rotations;
mod verdict;

pub(super) use fit::chi2_rows;
pub use page::calibration_sheet;
#[cfg(feature = "study")]
pub(super) use parameters::parameter_table;
pub(super) use quality::noise_explains;
pub(super) use verdict::{calibration_verdict, worst_gain};
