//! The checks after the fit, in the order in which a user reads what they say.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::checks::{
    axis_order, changes, chi_squared, coarse_steps, common_factor, convergence, extrapolation, gains,
    gyroscope_noise, hold_intervals, holds_left_out, lost_samples, motion_in_hold, rate_dependence,
    rotations_left_out, scatter, thermometer, time_offset, turns_of_known_angle,
};

/// Every check, in order.
const CHECKS: [fn(&Evidence<'_>) -> Diagnostics; 23] = [
    time_offset::check,
    changes::check,
    holds_left_out::check,
    motion_in_hold::check,
    hold_intervals::check,
    |evidence| evidence.turns.clone(),
    convergence::check,
    axis_order::check,
    rotations_left_out::check,
    scatter::of_rotations,
    scatter::of_worse_rotations,
    rate_dependence::check,
    scatter::at_rest,
    scatter::of_gains,
    lost_samples::check,
    turns_of_known_angle::check,
    chi_squared::check,
    common_factor::of_fit,
    gains::check,
    gyroscope_noise::check,
    coarse_steps::check,
    extrapolation::check,
    thermometer::check,
];

/// What all checks say.
pub(crate) fn all_checks(evidence: &Evidence<'_>) -> Diagnostics {
    CHECKS.iter().flat_map(|check| check(evidence)).collect()
}
