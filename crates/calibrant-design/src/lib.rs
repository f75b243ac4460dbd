//! Design: it finds the motion whose recording determines the parameters best, and bounds how far that is
//! from the optimum. It simulates studies of both.

mod active_set;
mod admissible;
mod admissible_region;
mod certificate;
mod certificate_words;
mod combined_axes;
mod conic_program;
mod criterion_hessian;
mod criterion_model;
mod evaluate;
mod feasibility;
mod goal;
mod initial_motion;
mod interruption;
mod kicks;
mod linear_limits;
mod long_program;
mod motion_assessment;
mod multistart_search;
mod part;
pub mod poses;
mod problem;
mod random_starts;
mod result;
mod sequential_programming;
mod settings;
mod short_program;
mod shortest;
mod solve;
pub mod study;
mod sweep;
mod work;

pub use admissible::{LimitKind, LimitUse, ROUNDING, limit_use};
pub use evaluate::evaluate;
pub use feasibility::check_feasible;
pub use goal::Goal;
pub use initial_motion::initial_motion;
pub use interruption::Interruption;
pub use motion_assessment::{Assessment, OtherSetting, assess};
pub use problem::DesignProblem;
pub use result::{AT_BEST, Certificate, Design, DesignStatus, Evaluation, StartOutcome};
pub use settings::DesignSettings;
pub use shortest::{ShortestMotion, shortest_motion};
pub use solve::design;
pub use sweep::{Sweep, SweepPoint, SweepVariable, sweep, sweep_work};
