//! The search: starts, an interior point on nested knots, and what is kept of it.

mod band;
mod gram;
mod interior_point;
mod multistart;
mod nested;
mod objective;
mod probe;
mod quasi_newton;
mod rows;
mod starts;

pub(crate) use interior_point::{InteriorPoint, Reached, Steps};
pub(crate) use multistart::{Found, HELD_BACK, levels, repaired, search};
pub(crate) use nested::Candidate;
pub(crate) use objective::{Kind, Objective};
pub(crate) use probe::Probe;
pub(crate) use rows::Rows;
pub(crate) use starts::Starts;
