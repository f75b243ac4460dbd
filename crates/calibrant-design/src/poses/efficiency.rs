//! How much of the information of one set of poses another has.

use calibrant_core::information::Criterion;

/// How efficient a design with this value is, from 0 to 1: the bound by the value. For D it is
/// `exp((bound − value) / p)`.
///
/// Both are ratios of an information `φ(M)` that doubles when all poses are taken twice (`pukelsheim2006`):
/// `1/Φ(M⁻¹)`, for D `det(M)^(1/p)`. So the efficiency means the same for all criteria. Without a prior, 1/2 says
/// that twice as many recordings are needed.
pub(super) fn efficiency(criterion: &Criterion, value: f64, bound: f64, parameters: usize) -> f64 {
    match criterion {
        Criterion::D(_) => ((bound - value) / parameters as f64).exp(),
        _ => bound / value,
    }
}
