//! Static multi-position calibration: the sensor is at rest in several unknown orientations, and gravity is the reference.
//!
//! ```text
//! minimise over S, b, f_j:  Σ_j (ȳ_j − S f_j − b)ᵀ V_j⁻¹ (ȳ_j − S f_j − b)   with |f_j| = g
//! V_j = diag(σ_w²)/n_j + σ_b² diag(gain²)
//! ```
//!
//! The structure is the arrowhead of a motion, with one unknown direction (two numbers) for each hold instead of a chain. `S` is in the chosen
//! gauge ([`Gauge`](crate::sensor::Gauge)). Each hold gives three numbers and takes two. J holds and p parameters leave J − p degrees of freedom.
//!
//! # Where the covariance comes from
//! Samples within a hold are correlated and share the hold's own error, so the scatter *between* holds decides. `σ_w` is the pooled scatter
//! within holds. `σ_b` makes χ² equal to its degrees of freedom (`paule1982`). It is zero if the noise within holds explains the scatter.
//! [`HoldCalibration`](super::HoldCalibration) states which of the two decides. The length of a hold only matters for the noise within it.
//!
//! Gravity's own uncertainty is a common factor of `S`: it adds `(∂p/∂g)(∂p/∂g)ᵀ σ_g²`, with `∂S/∂g = −S/g`.
//!
//! # Bad holds
//! A robust fit (Tukey's biweight) finds candidates. A hold is not used if its studentised deletion residual is beyond the 1 % point of Student's t,
//! with a Bonferroni correction for the number of holds. The result lists unused holds with their residual. A hold in which the sensor saturates
//! is removed before the fit (`saturated_holds`).

mod accelerometer_change;
mod bent_response;
mod calibrate;
mod coarse_steps;
mod drift_fit;
mod expected_accuracy;
mod fit;
mod hold_detection;
mod low_pass_filtered;
mod orientation_coverage;
mod recording_biases;
mod refused_rests;
mod residuals;
mod robust;
mod robust_weights;
mod saturated_holds;
mod setup;
mod sphere;
mod verdict;

pub(super) use bent_response::{TermsFit, finding as finding_of_terms};
pub(super) use calibrate::calibrate;
pub(super) use coarse_steps::coarse_steps;
pub(super) use residuals::magnitude_rms;
pub(super) use robust_weights::critical;
pub(super) use saturated_holds::{reason as clipped_reason, with_clipped};
pub(super) use sphere::sphere;
pub(super) use verdict::{are_correlated, left_out};

pub use expected_accuracy::{ExpectedCalibration, expected_calibration};
pub(super) use hold_detection::{ROUNDED_TIME_STEPS, as_recorded, beyond, median};
pub use hold_detection::{find_clean_holds, find_holds, holds_between};
pub use low_pass_filtered::holds_lost_to_filter;
pub(super) use low_pass_filtered::with_filter;
pub use orientation_coverage::{Coverage, coverage};
pub use refused_rests::{RefusedRest, refused_rests};
pub use saturated_holds::clipped_holds;
pub use setup::HoldsSetup;
