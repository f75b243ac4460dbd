//! From a recording to parameters with an honest covariance.
//!
//! ```text
//! minimise over p, a:  ½ Σ_k ‖y_k − S α(t_k; a) − b‖²_{Σ_ν⁻¹}
//!                    + ½ Σ_i ‖(a_{i+1} − a_i)/Δτ − u_i‖²_{Σ_{w,i}⁻¹}
//!                    + anchors (known start, known end) + optional prior on p
//! ```
//!
//! [`Trust`](crate::motion::Trust) in the commanded motion tells the report's problems (5), (6) and (3) apart; a static calibration has an
//! unknown direction for each hold instead of a chain ([`HoldsSetup`]). Both end in a [`Calibration`].
//!
//! The covariance is the inverse of the information `F` that is left for the parameters once motion or directions are
//! eliminated (Schur complement, [`arrowhead`](crate::arrowhead)). It holds to first order in the noise, for noise that is white,
//! Gaussian and as large as assumed; the fit's [`FitStatistics`] say whether the data agree.

mod between_hold_variance;
mod calibrate;
mod change;
mod comparison;
mod earth;
mod gravity_error;
mod gravity_off_earth;
mod holds;
mod imu;
mod motion;
mod problem;
mod quantisation;
mod quantised_noise;
mod result;
mod settings;
mod skewed_spikes;
pub(crate) mod statistics;
mod tangent_plane;
mod uncalibrated;
mod unknown_latitude;
mod validation;

pub use crate::diagnostic::{Change, Changed, Course};
pub use calibrate::calibrate;
pub use comparison::{ComparedQuantity, Comparison, OverallDifference};
pub use holds::{
    Coverage, ExpectedCalibration, HoldsSetup, clipped_holds, coverage, expected_calibration,
    find_clean_holds, find_holds, holds_between, holds_lost_to_filter,
};
pub use imu::{
    ClockRate, Gyroscope, GyroscopeCalibration, GyroscopeInHolds, ImuProblem, ImuSetup, KnownTerm,
    NoiseSource, RotationResult, ThermalModel, Turn, TurnResult, WhiteNoise, WhiteNoiseSearch, calibrate_imu,
    calibrate_imu_with, find_clean_imu_holds, find_imu_holds, swapped_sensors,
};
pub use problem::{CalibrationProblem, Stimulus};
pub use quantisation::{CoarseAxis, coarse_axes, coarse_axes_in};
pub use result::*;
pub use settings::CalibrationSettings;
pub use uncalibrated::Uncalibrated;
pub use validation::{
    BiasShift, Caveat, CoarseStep, CovarianceVerdict, ErrorKind, FailedFold, LikelyExplanation, NoiseRatio,
    ParameterPart, UnusedError, ValidatedErrors, Validation, ValidationSource, cross_validate,
    cross_validate_imu, other_temperature, validate, validate_imu,
};
