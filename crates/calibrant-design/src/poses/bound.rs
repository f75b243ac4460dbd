//! The bound that no set of n allowed poses can beat.
//!
//! Let W be a weight with `Φ(C′) ≥ tr(W C′)` for every covariance C′. For A, c and I it is the criterion's
//! own. For E it is any `Z ⪰ 0` of trace one, for M the diagonal of any shares with the sum one, both on the
//! scaled parameters. The function `1 / tr(W M⁻¹)` is concave in the information M, and homogeneous of degree
//! one. So it lies below its tangent planes: at any M with `C = M⁻¹` and `Ω = C W C`
//!
//! `1 / tr(W M′⁻¹) ≤ tr(Ω M′) / tr(W C)²`.
//!
//! For `M′ = M₀ + Σ m(u_k)` with n allowed directions `tr(Ω M′) ≤ tr(Ω M₀) + n max_u d(u) = B`. Hence
//! `Φ(C′) ≥ tr(W C)² / B`. For D the same with `det^(1/p)`, and `Ω = C`: `ln det C′ ≥ ln det C − p ln(B/p)`.
//! At the optimal approximate design both sides are equal (`kiefer1960`).
//!
//! # The maximum of d over the sphere
//! Along a great circle, d is a trigonometric polynomial of degree 4 for sensors with equal gains and noise on
//! all axes. It lies between 0 and its maximum D. By Bernstein's inequality its second derivative is at most
//! `4² D/2`. A grid with a point within δ of every direction therefore misses at most `4 δ² D`. Degree 6 is
//! taken in place of 4, since gains differ a little.

use super::hold_information::{Gain, HoldInformation};
use super::smooth_criterion::SmoothCriterion;
use calibrant_core::information::Criterion;
use nalgebra::{DMatrix, Vector3};
use rayon::prelude::*;

/// Degree of d along a great circle.
const DEGREE: f64 = 6.0;

/// A bound, and the directions that would raise it.
pub(super) struct Bound {
    /// `Φ(C′)` is at least this for any n allowed poses.
    pub(super) value: f64,
    /// Local maxima of d on the grid, the greatest first.
    pub(super) best: Vec<Vector3<f64>>,
}

/// The bound from the covariance C of an approximate design.
pub(super) fn bound(
    information: &HoldInformation,
    grid: &(Vec<Vector3<f64>>, f64),
    criterion: SmoothCriterion<'_>,
    c: &DMatrix<f64>,
    poses: usize,
) -> Bound {
    let (_, derivative) = criterion.at(c);
    let size = c.nrows() as f64;
    // the weight W, and for D the inverse of C
    let weight = match criterion.criterion {
        Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => criterion.criterion.derivative(c),
        Criterion::D(_) => derivative * size,
        Criterion::E(e) => {
            let trace: f64 = (0..c.nrows()).map(|i| derivative[(i, i)] * e.scale[i] * e.scale[i]).sum();
            derivative / trace
        }
        Criterion::M(m) => {
            let trace: f64 = (0..c.nrows()).map(|i| derivative[(i, i)] * m.scale[i] * m.scale[i]).sum();
            derivative / trace
        }
    };
    let omega = c * &weight * c;
    let gain = information.gain(&omega);
    let (most, best) = greatest(&gain, grid);
    let all = omega.dot(information.prior()) + poses as f64 * most;
    let value = match criterion.criterion {
        Criterion::D(_) => criterion.criterion.value(c) - size * (all / size).ln(),
        _ => weight.dot(c).powi(2) / all,
    };
    Bound { value, best }
}

/// An upper bound of d, and its local maxima on the grid.
fn greatest(gain: &Gain<'_>, (grid, radius): &(Vec<Vector3<f64>>, f64)) -> (f64, Vec<Vector3<f64>>) {
    let mut values: Vec<(f64, Vector3<f64>)> = grid.par_iter().map(|u| (gain.at(u), *u)).collect();
    values.sort_by(|one, other| other.0.total_cmp(&one.0));
    let most = values.first().map_or(0.0, |(value, _)| *value);
    // the greatest that are not close together
    let mut best: Vec<Vector3<f64>> = Vec::new();
    for (_, u) in values.iter().take_while(|(value, _)| *value > most * (1.0 - NEARLY)) {
        if best.len() < LOCAL && best.iter().all(|other| other.dot(u) < APART) {
            best.push(*u);
        }
    }
    (most / (1.0 - DEGREE * DEGREE * radius * radius / 4.0), best)
}

/// Share below the maximum of d down to which directions are of interest.
const NEARLY: f64 = 0.02;
/// Most of them.
const LOCAL: usize = 12;
/// Cosine of the angle between them.
const APART: f64 = 0.97;
