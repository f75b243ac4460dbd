//! A calibration on data that were not used for it: is its covariance to be believed?
//!
//! Three kinds of errors are known without any reference: the corrected magnitude in a hold less gravity, the corrected rate in it, and gravity carried by the
//! gyroscope to the next hold less gravity found there. For each, the calibration predicts a covariance
//!
//! ```text
//! C = D + J Σ Jᵀ
//! ```
//!
//! `Σ` that of the parameters (which all errors have in common), `D` of noise and of the scatter between holds or rotations that the calibration found.
//! `eᵀ C⁻¹ e` over its degrees of freedom is then about 1 if all of that is right; its root is the factor by which the standard deviations are off.
//!
//! Gravity is taken to be the one of the calibration, so that its uncertainty moves corrected and true magnitude alike and counts for neither. The bias of a
//! gyroscope may differ each time it is switched on: in another recording it is compared first, and where it has moved the rest is judged with the bias it has moved to.
//!
//! # Folds
//! The errors of all blocks are pooled, each with the covariance of the calibration without it. These calibrations share data, so the errors of different blocks are
//! correlated and the distribution of the pooled χ² is approximate (`bengio2004`); its mean is right.
//!
//! # References
//! `viechtbauer2007`, `bengio2004`

mod caveats_of_calibration;
mod chi_square_ratio;
mod covariance_verdict;
mod cross_validation;
mod differences;
mod error_ratio;
mod explanations;
mod folds;
mod hold_prediction;
mod inputs;
mod judgement;
mod noise_comparison;
mod over_temperature;
mod predicted_error;
mod prediction;
mod prediction_errors;
mod result;
mod scatter_comparison;
mod statistics;
mod unused_error;
mod validate;
mod whitened_errors;

pub use covariance_verdict::CovarianceVerdict;
pub use cross_validation::{cross_validate, cross_validate_imu};
pub use explanations::other_temperature;
pub use noise_comparison::{CoarseStep, NoiseRatio};
pub use over_temperature::{HeldOutRecording, HoldScatter, validate_over_temperature};
pub use result::*;
pub use unused_error::{ErrorKind, UnusedError};
pub use validate::{validate, validate_imu};
