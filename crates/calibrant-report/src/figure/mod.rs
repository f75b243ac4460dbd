//! Figures as data: panels of series with a title, a legend and a caption, drawn at the very end.
//!
//! A [`Figure`] becomes one `<figure>`. Its panels are beside each other where there is room, and else below
//! each other. Each is an SVG of its own that scales with its column, so that letters stay legible on a
//! phone. The legend comes from the series themselves.

mod allan;
mod bars;
mod batch;
mod before_after;
mod budget;
mod campaign;
mod campaign_fit;
mod colour;
mod correlation;
#[cfg(feature = "study")]
mod design_population;
mod device;
mod drawing;
mod durations;
mod ellipse;
mod files;
mod frame;
mod gyroscope_in_holds;
mod histogram;
mod holds;
mod kinds;
mod machine;
mod map;
mod motion;
mod motion_pair;
mod panel;
mod point_thinning;
#[cfg(feature = "study")]
mod population;
#[cfg(feature = "study")]
mod rehearsal;
mod residuals;
mod rotations;
mod scale;
mod sphere;
mod starts;
#[cfg(feature = "study")]
mod surface;
mod svg;
mod sweep;
mod ticks;
mod unit;
mod validation;
mod view;

pub(super) use allan::allan_figure;
pub(super) use bars::Bars;
pub(super) use batch::{SENSORS, code_bars, drifts, parameter_histograms};
pub(super) use before_after::{holds_before_and_after, recording_before_and_after};
pub(super) use budget::{budget_bars, source_in_words};
pub(super) use campaign::{sd_over_temperature, sd_over_time, temperature_over_time};
pub(super) use campaign_fit::{curves_over_temperature, residuals_of_soaks};
pub(super) use correlation::correlation_map;
#[cfg(feature = "study")]
pub(super) use design_population::{absolute_errors, optimal_motions, traces};
pub(super) use device::device;
pub(super) use durations::duration_curves;
pub(super) use ellipse::confidence_ellipses;
pub(super) use files::Drawable;
pub use files::FigureFiles;
pub(super) use frame::{Figure, drawn};
pub(super) use gyroscope_in_holds::{bias_over_temperature, still_gyroscope};
pub(super) use holds::{hold_residuals, recording_overview, rest_and_motion};
pub(super) use machine::{
    PLAYER_SCRIPT, Scene, correction_bars, joint_figure, player, residual_coherence, residual_densities,
    residuals_and_speed, sensor_on_tip, three_views,
};
pub(super) use motion::{acceleration_figure, motion_error_figure, state_and_jerk_figure};
pub(super) use motion_pair::{Drawn, jerk_and_acceleration, states, velocity_and_displacement};
#[cfg(feature = "study")]
pub(super) use population::{p_values, parameter_errors, parameters_against_truth, standardised_errors};
#[cfg(feature = "study")]
pub(super) use rehearsal::{rehearsed_errors, rehearsed_sds};
pub(super) use residuals::{autocorrelations, histograms, residuals_over_time};
pub(super) use rotations::rotation_errors;
pub(super) use sphere::{hold_directions, pose_directions};
pub(super) use starts::start_values;
#[cfg(feature = "study")]
pub(super) use surface::trace_map;
pub(super) use sweep::sweep_curves;
pub(super) use unit::DisplayUnit;
pub(super) use validation::validation_errors;
