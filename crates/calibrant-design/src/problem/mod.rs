//! What a design is asked for: the problem, the goal and the settings.

pub(crate) mod design_problem;
pub(crate) mod goal;
pub(crate) mod settings;
