//! Static multi-position calibration: the sensor held still in several orientations, directions unknown, magnitude g.
//!
//! ```text
//! minimise over S, b, f_j:  Σ_j (ȳ_j − S f_j − b)ᵀ V_j⁻¹ (ȳ_j − S f_j − b)   with |f_j| = g
//! V_j = diag(σ_w²)/n_j + σ_b² diag(gain²)
//! ```
//!
//! The same arrowhead as for a motion, with one unknown direction (two numbers) for each hold instead of a chain; `S` in the gauge asked
//! for ([`Gauge`](crate::sensor::Gauge)). Each hold gives three numbers and takes two: with J holds and p parameters, J − p degrees of freedom.
//!
//! # Where the covariance comes from
//! Samples within a hold are correlated and share the hold's own error, so the scatter *between* holds decides. `σ_w` is the pooled scatter
//! within holds; `σ_b` is chosen such that χ² equals its degrees of freedom (Paule and Mandel 1982), zero if the noise within holds
//! already explains the scatter. So the covariance is the larger of the two, and [`HoldCalibration`](super::HoldCalibration) says which it was. Long holds count by
//! their length only as far as noise within holds matters.
//!
//! Gravity's own uncertainty is a common factor of `S`: it adds `(∂p/∂g)(∂p/∂g)ᵀ σ_g²`, with `∂S/∂g = −S/g`.
//!
//! # Bad holds
//! A robust fit (Tukey's biweight) finds candidates; a hold is left out when its studentised deletion residual is beyond the 1 %
//! point of Student's t, Bonferroni-corrected for the number of holds. Holds left out are listed with their residual. A hold in which the sensor stops at the end of
//! its range is left out before that (`clipped`).

mod accelerometer_change;
mod calibrate;
mod coarse_steps;
mod expected_accuracy;
mod fit;
mod hardly_determined;
mod hold_detection;
mod holds_with_pauses;
mod low_pass_filtered;
mod orientation_coverage;
mod residuals;
mod robust_weights;
mod saturated_holds;
mod setup;
mod sphere;
mod verdict;

pub(super) use calibrate::calibrate;
pub(super) use coarse_steps::coarse_steps;
pub(super) use residuals::magnitude_rms;
pub(super) use robust_weights::critical;
pub(super) use saturated_holds::{reason as clipped_reason, with_clipped};
pub(super) use sphere::sphere;
pub(super) use verdict::left_out;

pub use expected_accuracy::{ExpectedCalibration, expected_calibration};
pub(super) use hold_detection::{as_recorded, beyond, median};
pub use hold_detection::{find_clean_holds, find_holds, holds_between};
pub(super) use holds_with_pauses::with_pauses;
pub use low_pass_filtered::holds_lost_to_filter;
pub(super) use low_pass_filtered::with_filter;
pub use orientation_coverage::{Coverage, coverage};
pub use saturated_holds::clipped_holds;
pub use setup::HoldsSetup;
