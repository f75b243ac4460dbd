//! The best trajectory of a kinematic chain for calibrating the inertial sensor that it carries.

mod bound;
mod certificate;
#[cfg(test)]
mod chains_for_tests;
mod design;
mod evaluate;
mod information;
mod limits;
mod motion;
mod problem;
mod recursion;
mod search;
#[cfg(test)]
mod spheres_for_tests;

pub use bound::TrajectoryBound;
pub use certificate::{Kept, LimitProof, TrajectoryLimit};
pub use design::{TrajectoryDesign, TrajectoryStart, design_trajectory};
pub use evaluate::{TrajectoryEvaluation, evaluate_trajectory};
pub use information::TrajectoryCriterion;
pub use limits::{BodyPair, JointLimit, Proximity, SensorBody, SpeedNearEnds, Surroundings};
pub use problem::{Dwells, TrajectoryNoise, TrajectoryProblem, TrajectorySettings};
