//! Convex programs and what solves them; no file here knows what a motion is good for.

pub(crate) mod active_set;
pub(crate) mod chain_factor;
pub(crate) mod chain_program;
pub(crate) mod conic_program;
pub(crate) mod eigenvalue_cone;
