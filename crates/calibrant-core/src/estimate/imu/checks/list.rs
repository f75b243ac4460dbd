//! The checks after the fit, in the order in which a user reads what they say.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::checks::{
    axis_order, changes, chi_squared, coarse_steps, convergence, extrapolation, gains, gyroscope_noise,
    hold_intervals, holds_left_out, lost_samples, motion_in_hold, rotations_left_out, time_offset,
    turns_of_known_angle,
};

/// Every check, in order.
const CHECKS: [fn(&Evidence<'_>) -> Diagnostics; 16] = [
    time_offset::check,
    changes::check,
    holds_left_out::check,
    motion_in_hold::check,
    hold_intervals::check,
    |evidence| evidence.turns.clone(),
    convergence::check,
    axis_order::check,
    rotations_left_out::check,
    lost_samples::check,
    turns_of_known_angle::check,
    chi_squared::check,
    gains::check,
    gyroscope_noise::check,
    coarse_steps::check,
    extrapolation::check,
];

/// What all checks say.
pub(crate) fn all_checks(evidence: &Evidence<'_>) -> Diagnostics {
    CHECKS.iter().flat_map(|check| check(evidence)).collect()
}
