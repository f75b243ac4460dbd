//! Where the iteration begins: splines through the log, the placement of the recording, and the motion trusted.

pub(crate) mod covered;
pub(crate) mod initial;
pub(crate) mod knot_choice;
pub(crate) mod placement;
pub(crate) mod reference_fit;
pub(crate) mod start;
pub(crate) mod trusted;
