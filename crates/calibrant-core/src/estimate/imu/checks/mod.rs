//! Checks of the data, one file for each mistake.
//!
//! Those of `list` look at the fit ([`evidence::Evidence`]), say what a user should know, and change nothing. The others refuse data before the fit.

pub(crate) mod accelerometer_gains;
pub(crate) mod axes_in_words;
pub(crate) mod axes_without_rotation;
pub(crate) mod axis_order;
pub(crate) mod changes;
pub(crate) mod changing_gyroscope;
pub(crate) mod chi_squared;
pub(crate) mod coarse_steps;
pub(crate) mod common_factor;
pub(crate) mod convergence;
pub(crate) mod directions;
pub(crate) mod evidence;
pub(crate) mod extrapolation;
pub(crate) mod gains;
pub(crate) mod gyroscope_noise;
pub(crate) mod gyroscope_unit;
pub(crate) mod hold_intervals;
pub(crate) mod holds_left_out;
pub(crate) mod identifiability;
pub(crate) mod known_terms;
pub(crate) mod list;
pub(crate) mod lost_samples;
pub(crate) mod missed_gravity;
pub(crate) mod motion_in_hold;
pub(crate) mod rate_dependence;
pub(crate) mod rotations_left_out;
pub(crate) mod scatter;
pub(crate) mod swapped_sensors;
pub(crate) mod thermometer;
pub(crate) mod time_offset;
pub(crate) mod time_offset_by_activity;
pub(crate) mod turns_of_known_angle;
pub(crate) mod wrong_faces;
pub(crate) mod wrong_turns;
