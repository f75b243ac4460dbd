//! The certificate: a lower bound on the criterion that no admissible motion can beat. It shows how far a
//! motion can be from the best at most.
//!
//! A search finds good motions and cannot show that there is no better one. The certificate works from the
//! other side. The variance of a parameter is smallest where other parameters are given for free. Let `F⁰` be
//! the information that is there already, σ the noise of a reading and M the number of samples. Then
//!
//! `C_bb ≥ 1/(F_bb + F⁰_bb)`, `C_KK ≥ 1/(V/σ² + F⁰_KK)`, `V = Σ α² − (Σ α + σ² F⁰_bK)²/(M + σ² F⁰_bb)`,
//!
//! with `F_bb` the information on the bias where the scale factor is known (`M/σ²` where the motion is
//! known). The motion decides V, the motion variance, and [`motion_variance`] bounds it from above. An
//! element `S_rk` of a full matrix is bounded as if axis k could be moved on its own.
//!
//! Every criterion is at least its value at the diagonal matrix of these bounds. A, M and c weight variances.
//! For E, the largest eigenvalue is no smaller than any diagonal entry. For D, the determinant of the
//! information is at most the product of the information on each parameter (Hadamard, Fischer). I is
//! `tr(W C)`, with `W ⪰ λ diag(W)` where W is not diagonal.
//!
//! # A motion that is not known
//! Process noise only removes information, so all of the above holds. Where only the start is known there is
//! a second bound. With perfect readings, the scale factor would still follow from noisy increments,
//! `F_KK ≤ Σ (u_i/(K σ_u(u_i)))²`, and each term grows with the jerk. For a full sensor the elements of S compete
//! for the motion, and [`increment_design`] bounds all of them together. Where only the ends are known,
//! `C_KK = c/(a_N − a_0)²` with a constant c, and the limits bound the distance of the ends.

mod bounds;
#[cfg(test)]
mod design_tests;
mod dual_bound;
mod gravity;
mod increment_design;
#[cfg(test)]
mod increment_tests;
mod largest_gain;
mod moment_relaxation;
mod moment_solver;
mod motion_variance;
mod polynomial;
#[cfg(test)]
mod tests;
mod variances;

pub(crate) use bounds::{AxisChain, States};
pub(super) use variances::{LowerBound, lower_bound};
