//! Figures of a machine and of the sensor on it.
//!
//! The pictures of the machine are drawn here, since scenes that turn are no panels.

mod geometry;
mod joints;
mod mount;
mod player;
mod residuals;
mod scene;
mod spectrum;
mod views;

pub(crate) use geometry::correction_bars;
pub(crate) use joints::joint_figure;
pub(crate) use mount::sensor_on_tip;
pub(crate) use player::{PLAYER_SCRIPT, player};
pub(crate) use residuals::residuals_and_speed;
pub(crate) use scene::Scene;
pub(crate) use spectrum::{residual_coherence, residual_densities};
pub(crate) use views::three_views;
