//! Least squares as all estimates share them: what does not depend on a sensor.
//!
//! ```text
//! χ²(x) = Σ_j r_jᵀ W_j r_j + Σ_k w_k (p_k − m_k)²      unknowns x = (p, nodes), F the information of p, Σ = F⁻¹
//! ```
//!
//! | step | equation | file |
//! |---|---|---|
//! | What are the unknowns? | `(F + λ diag F) δp = g`, nodes eliminated by [`arrowhead`](crate::arrowhead) | `gauss_newton` |
//! | Are the parameters determined? | eigenvalues of `F_ij/√(F_ii F_jj)` | `identify`, `hardly_determined` |
//! | How large are the variances? | `χ²(σ) = ν`, with `W_j = (V_j + σ² I)⁻¹` | `variance` |
//! | How many residuals are left? | `ν = n − (p − Σ_k w_k Σ_kk)` | `degrees` |
//! | Which residuals are bad? | `r/√(V ∓ J Σ Jᵀ)`, one change at a time | `studentised`, `leave_out` |
//! | What is the covariance, and of what? | `Σ + Σ_s R_s R_sᵀ` | `uncertainty` |
//! | What is probable? | tails of χ² and of Fisher's F | `statistics` |

mod degrees;
mod gauss_newton;
mod hardly_determined;
mod identify;
mod leave_out;
mod statistics;
mod status;
mod studentised;
mod uncertainty;
mod variance;

pub(crate) use degrees::degrees_left;
pub use degrees::shares_of_prior;
pub(crate) use gauss_newton::{Equations, LeastSquares, LoopSettings, Minimum, minimise};
pub(crate) use hardly_determined::hardly_determined;
pub(crate) use identify::ScaledInformation;
pub(crate) use leave_out::{Judged, leave_out};
pub(crate) use statistics::{MANY_DEGREES, chi2_of_p_value};
pub use statistics::{chi2_p_value, f_p_value};
pub use status::CalibrationStatus;
pub(crate) use studentised::{Scatter, studentised, studentised_length};
pub(crate) use uncertainty::Uncertainty;
pub use uncertainty::VarianceSource;
pub(crate) use variance::{Trial, excess};
