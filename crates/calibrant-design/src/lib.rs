//! Design: the motion whose recording determines the parameters best, and the proof of how good it is.

mod admissible;
mod assessment;
mod certificate;
mod conic;
mod curvature;
mod evaluate;
mod feasibility;
mod hessian;
mod initial;
mod local;
mod part;
mod problem;
mod region;
mod result;
mod search;
mod settings;
mod solve;
mod starts;
mod statement;
pub mod study;
mod sweep;

pub use admissible::{LimitKind, LimitUse, ROUNDING, limit_use};
pub use assessment::{Assessment, OtherSetting, assess};
pub use evaluate::evaluate;
pub use feasibility::check_feasible;
pub use initial::initial_motion;
pub use problem::DesignProblem;
pub use result::{AT_BEST, Certificate, Design, DesignStatus, Evaluation, StartOutcome};
pub use settings::DesignSettings;
pub use solve::design;
pub use sweep::{Sweep, SweepPoint, SweepVariable, sweep};
