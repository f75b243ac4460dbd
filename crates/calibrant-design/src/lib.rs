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
pub use limits::admissible::{LimitKind, LimitUse, ROUNDING, limit_use};
pub use limits::feasibility::check_feasible;
pub use limits::initial_motion::initial_motion;
pub use problem::design_problem::DesignProblem;
pub use problem::goal::Goal;
pub use problem::settings::DesignSettings;
pub use result::design::{AT_BEST, Certificate, Design, DesignStatus, Evaluation, GapGoal, StartOutcome};
pub use result::evaluate::evaluate;
pub use result::motion_assessment::{Assessment, OtherSetting, assess};
pub use search::so_far::SoFar;
pub use task::shortest::{ShortestMotion, shortest_motion};
pub use task::solve::design;
pub use task::sweep::{Sweep, SweepPoint, SweepVariable, sweep, sweep_work};
pub use task::trace_surface::{SurfaceSettings, TraceSurface, trace_surface};
