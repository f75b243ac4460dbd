//! The motions that the limits admit: the exact check, the region of one axis, and whether there is one at all.

mod admissible;
mod admissible_region;
mod feasibility;
mod initial_motion;

pub(crate) use admissible::worst_violation;
pub use admissible::{LimitKind, LimitUse, ROUNDING, limit_use};
pub(crate) use admissible_region::{InsideBreach, Region, State, WatchedIntervals};
pub use feasibility::check_feasible;
pub(crate) use feasibility::inside;
pub use initial_motion::initial_motion;
