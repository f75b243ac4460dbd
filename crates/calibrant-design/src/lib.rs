//! Design: it finds the motion whose recording determines the parameters best, and bounds how far that is
//! from the optimum.

mod certificate;
mod convex;
mod criterion;
mod limits;
mod local_search;
pub mod poses;
mod problem;
mod result;
mod search;
mod task;

pub use calibrant_core::interruption::Interruption;
pub use limits::{LimitKind, LimitUse, ROUNDING, check_feasible, initial_motion, limit_use};
pub use problem::{DesignProblem, DesignSettings, Goal};
pub use result::{
    AT_BEST, Assessment, Certificate, Design, DesignStatus, Evaluation, GapGoal, OtherSetting, StartOutcome,
    assess, evaluate,
};
pub use search::SoFar;
pub use task::{
    ShortestMotion, SurfaceSettings, Sweep, SweepPoint, SweepVariable, TraceSurface, design, shortest_motion,
    sweep, sweep_work, trace_surface, usual_motion,
};
