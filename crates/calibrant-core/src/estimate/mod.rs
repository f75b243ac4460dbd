//! Estimates parameters and their covariance from a recording.
//!
//! ```text
//! minimise over p, a:  ½ Σ_k ‖y_k − S α(t_k; a) − b‖²_{Σ_ν⁻¹}
//!                    + ½ Σ_i ‖(a_{i+1} − a_i)/Δτ − u_i‖²_{Σ_{w,i}⁻¹}
//!                    + anchors (known start, known end) + optional prior on p
//! ```
//!
//! [`Trust`](crate::motion::Trust) in the commanded motion chooses between the thesis's problems (5), (6) and (3). A static calibration has an
//! unknown direction for each hold instead of a chain ([`HoldsSetup`]). An IMU ([`ImuProblem`])
//! adds rotations of its gyroscope. All end in a [`Calibration`].
//!
//! The covariance is the inverse of the information `F` of the parameters after motion or directions are eliminated (Schur complement,
//! [`arrowhead`](crate::arrowhead)). It holds to first order, for white Gaussian noise of the assumed size. [`FitStatistics`] state whether the data
//! agree with that.

mod alignment;
mod at_rest;
mod bias_drift;
mod budget;
mod calibrate;
mod change;
mod comparison;
mod datasheet;
mod earth;
mod effective_degrees;
mod gravity_error;
mod gravity_off_earth;
mod hold_result;
mod hold_variance;
mod holds;
mod imu;
mod json;
mod motion;
mod motion_outliers;
mod problem;
mod propagated;
mod quantisation;
mod quantised_noise;
mod recording_biases;
mod recovered_clock;
mod recovered_gravity;
mod repeated_readings;
mod result;
mod settings;
mod soak;
mod studentised_fit;
mod tangent_plane;
mod uncalibrated;
mod uncertain_gravity;
mod unknown_latitude;
mod validation;

pub use crate::diagnostic::{Change, Changed, Course};
pub use crate::solve::{CalibrationStatus, VarianceSource, chi2_p_value, f_p_value, shares_of_prior};
pub use bias_drift::BiasDrift;
pub use budget::BudgetRow;
pub use calibrate::calibrate;
pub use comparison::{ComparedQuantity, Comparison, OverallDifference, Place};
pub use datasheet::{
    ALLOWED_SPREADS, allows_gain, beyond_datasheet, common_factor, implausible_bias, implausible_gains,
    noise_implausible, noise_not_as_given,
};
pub use effective_degrees::degrees_of_sum;
pub use gravity_error::{gravity_source, shared_gravity, tells_its_place};
pub use hold_result::{FaceTilt, HoldCalibration, HoldResult, TiltSource};
pub use holds::{
    Coverage, ExpectedCalibration, HoldsSetup, RefusedRest, clipped_holds, coverage, expected_calibration,
    find_clean_holds, find_holds, holds_between, holds_lost_to_filter, refused_rests,
};
pub use imu::{
    ClockRate, FacesFound, Gyroscope, GyroscopeCalibration, GyroscopeInHolds, ImuProblem, ImuSetup,
    KnownTerm, NoiseSource, ON_FACE_RAD, RotationResult, ThermalModel, ThermometerLag, TimeOffset, Turn,
    TurnResult, WhiteNoise, WhiteNoiseSearch, calibrate_faces, calibrate_imu, calibrate_imu_with,
    faces_found, find_clean_imu_holds, find_imu_holds, swapped_sensors,
};
pub use json::{Budget, FitInUnit};
pub use motion_outliers::without_motion_outliers;
pub use problem::{CalibrationProblem, FacesProblem, Stimulus};
pub use quantisation::{CoarseAxis, coarse_axes, coarse_axes_in};
pub use recording_biases::{RecordingBiases, recording_at};
pub use recovered_clock::RecoveredClock;
pub use recovered_gravity::RecoveredGravity;
pub use repeated_readings::repeated_readings;
pub use result::*;
pub use settings::CalibrationSettings;
pub use soak::SoakTemperature;
pub use uncalibrated::Uncalibrated;
pub use uncertain_gravity::UncertainGravity;
pub use unknown_latitude::UnknownLatitude;
pub use validation::{
    BiasShift, CoarseStep, CovarianceVerdict, ErrorKind, FailedFold, HeldOutRecording, HoldScatter,
    NoiseRatio, ParameterPart, UnusedError, ValidatedErrors, Validation, ValidationSource, cross_validate,
    cross_validate_imu, other_temperature, validate, validate_imu, validate_over_temperature,
};
