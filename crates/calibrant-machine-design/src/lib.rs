//! The best trajectory of a kinematic chain for calibrating the inertial sensor that it carries.
//!
//! # Problem
//! The positions of the joints are uniform cubic B-splines from rest to rest. Their control points `c` minimise a criterion of the covariance of the sensor's parameters,
//! with everything else that is not known exactly marginalised under its prior, subject to the limits of the joints, the range of the sensor, speeds and distances, for
//! all times.
//!
//! # Way
//! ```text
//! random admissible starts → interior point on knots 0.8 → 0.4 → 0.2 s, nuisances known → polish, nuisances marginalised → certificate → evaluation, bound
//! ```
//!
//! Each module has its derivation at its head: `motion`, `recursion`, `information`, `limits`, `search`, `certificate`, `bound`.

mod bound;
mod certificate;
#[cfg(test)]
mod chains_for_tests;
mod design;
mod durations;
mod evaluate;
mod information;
mod limit_name;
mod limits;
mod motion;
mod plain;
mod problem;
mod recursion;
mod search;
#[cfg(test)]
mod spheres_for_tests;
mod start;
mod turned_cross_terms;
pub mod world;

pub use bound::TrajectoryBound;
pub use certificate::{Kept, LimitProof, TrajectoryLimit};
pub use design::{TrajectoryDesign, design_trajectory};
pub use durations::{
    ShortestTrajectory, TrajectoryGoal, TrajectorySweep, TrajectorySweepPoint, shortest_trajectory,
    sweep_durations,
};
pub use evaluate::{TrajectoryEvaluation, evaluate_trajectory};
pub use information::TrajectoryCriterion;
pub use limits::{JointLimit, SensorBody, Surroundings};
pub use plain::{PlainRoutine, PlainTrajectory};
pub use problem::{Dwells, TrajectoryNoise, TrajectoryProblem, TrajectorySettings};
pub use start::TrajectoryStart;
