//! What a recording of a motion will tell of the sensor's parameters.
//!
//! # Formula
//! A reading of row `i` of a sensor is `φᵀ θ_i + Jᵢ η` about the nominal values, `φ = (1, f)` or `(1, w)`, with the sensor's parameters `θ` (24 entries: bias
//! and three of the matrix in each row) and what else is not known exactly, `η`: lever arm, mounting, tilt, gravity, delays, clock, zeros, geometry. With the noise
//! density `N` of the sensor the information is an integral,
//!
//! ```text
//! F = ∫ J(t)ᵀ J(t) / (N² g(t)) dt        g = 1 + κ s/(s + s₀²),  s = Σ q̇²,  κ = (noise moving / noise at rest)² − 1
//! ```
//!
//! by Gauss–Legendre points. The nuisances are marginalised under their priors `P`: `F_θ − F_θη (F_ηη + P)⁻¹ F_ηθ`.
//! *Plain* information takes them as known. It needs two 4×4 moment matrices alone, `Σ w φ φᵀ`, and is some 20 times cheaper.
//!
//! # Gradient
//! A criterion changes by `dΦ = −tr(Ω dF)`. With `E = (I, −K)`, `K = (F_ηη + P)⁻¹ F_ηθ`, a change of the full matrix counts as `E Ω Eᵀ`. With `G = E Ω Eᵀ Jᵀ`
//! for each sample and row this is `−2 w Gᵀ dJᵀ`, and `Gᵀ dJᵀ` is the change of a directional derivative of the reading: along `G_η` for the nuisances. Its sum over the rows is
//! differentiated in closed form, for all joints at once (`recursion/contraction`).

mod criterion;
mod directions;
mod full;
mod plain;
mod sampled;
mod sensing;
mod sensor_columns;
#[cfg(test)]
mod tests;
mod undetermined;

pub use criterion::TrajectoryCriterion;
pub(crate) use criterion::{Smooth, Valued};
pub(crate) use full::{FullInformation, Marginalised, solved};
pub(crate) use plain::PlainInformation;
pub(crate) use sampled::Sampled;
pub(crate) use sensing::{Sensing, moments};
pub(crate) use sensor_columns::{ENTRIES, entry};
pub(crate) use undetermined::undetermined;
