//! The motions that the limits admit: the exact check, the region of one axis, and whether there is one at all.

pub(crate) mod admissible;
pub(crate) mod admissible_region;
pub(crate) mod feasibility;
pub(crate) mod initial_motion;
