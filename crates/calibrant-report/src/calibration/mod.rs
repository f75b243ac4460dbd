//! The report page on one calibration, of an accelerometer alone or of a whole IMU.

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
mod temperature;
mod verdict;

pub use page::calibration_report;
pub use parameters::over_the_gain;
pub(super) use parameters::{column_notes, parameter_table};
pub(super) use quality::noise_explains;
pub use quality::{calibration_quality, nuisances_in_words, used_in_words};
pub use temperature::temperature_in_words;
pub(super) use verdict::calibration_verdict;
