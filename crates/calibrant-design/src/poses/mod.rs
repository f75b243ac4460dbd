//! The best poses of a static calibration: in which orientations to hold the sensor still.
//!
//! A hold in the direction u (the specific force is `f = g u`) has the mean reading `ȳ = S f + b + ε`. Its
//! information on the parameters p is `m(u) = Gᵀ N⁻¹ G` (`hold_information`), with `G = ∂(S f + b)/∂p`. N
//! is the covariance of the mean reading, the error of the direction included. n holds have the information
//!
//! `M = M₀ + Σ m(u_k)`, with `M₀` the information that is there already, and `C = M⁻¹`.
//!
//! The best poses minimise a criterion `Φ(C)` over n allowed directions. That is an exact design, and has
//! many local optima (`search`). If the weights of the directions may be any numbers with the sum n, it is
//! a convex problem, the approximate design (`approximate`). Its optimum bounds all sets of n poses. By the
//! equivalence theorem of Kiefer and Wolfowitz the optimum can be recognised, and any approximate design
//! gives a bound (`bound`).
//!
//! # References
//! `kiefer1960`, `pukelsheim2006`

mod allowed;
mod approximate;
mod efficiency;
mod enough;
mod evaluate;
mod exchange;
mod fewest;
mod hold_information;
mod order;
mod problem;
mod result;
mod search;
mod spectral_projected_gradient;
#[cfg(test)]
mod tests;
mod usual;
mod work;

pub use allowed::Allowed;
pub use evaluate::{PoseEvaluation, covariance_of_holds, evaluate_poses, shares_of_holds};
pub use fewest::{FewestPoses, fewest_poses};
pub use problem::{DirectionKnowledge, PoseNuisance, PoseProblem};
pub use result::{PoseBound, PoseDesign};
pub use search::design_poses;
pub use usual::UsualPoses;
