//! The checks after the fit, in the order in which a user reads what they say.

use crate::estimate::imu::checks::axis_order;
use crate::estimate::imu::checks::changes;
use crate::estimate::imu::checks::chi_squared;
use crate::estimate::imu::checks::coarse_steps;
use crate::estimate::imu::checks::convergence;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::checks::extrapolation;
use crate::estimate::imu::checks::gains;
use crate::estimate::imu::checks::gravity_residuals;
use crate::estimate::imu::checks::gyroscope_noise;
use crate::estimate::imu::checks::hold_intervals;
use crate::estimate::imu::checks::holds_left_out;
use crate::estimate::imu::checks::known_values;
use crate::estimate::imu::checks::motion_in_hold;
use crate::estimate::imu::checks::rotations_left_out;
use crate::estimate::imu::checks::skewed_spikes;
use crate::estimate::imu::checks::time_offset;
use crate::estimate::imu::checks::turns_of_known_angle;

type Check = fn(&Evidence<'_>) -> Diagnostics;

const CHECKS: [Check; 18] = [
    time_offset::check,
    changes::check,
    holds_left_out::check,
    motion_in_hold::check,
    hold_intervals::check,
    |evidence| evidence.turns.clone(),
    convergence::check,
    axis_order::check,
    rotations_left_out::check,
    turns_of_known_angle::check,
    known_values::check,
    chi_squared::check,
    gravity_residuals::check,
    gains::check,
    gyroscope_noise::check,
    coarse_steps::check,
    skewed_spikes::check,
    extrapolation::check,
];

/// What all checks say.
pub(crate) fn all_checks(evidence: &Evidence<'_>) -> Diagnostics {
    CHECKS.iter().flat_map(|check| check(evidence)).collect()
}
