//! Tangents of a criterion: bounds on its value from a bound on a linear function of the information.
//!
//! Let W be a weight with `Φ(C′) ≥ tr(W C′)` for every covariance C′. For A, c and I it is the criterion's
//! own. For E it is any `Z ⪰ 0` of trace one, for M the diagonal of any shares with the sum one, both on the
//! scaled parameters. The function `1 / tr(W M⁻¹)` is concave in the information M, and homogeneous of degree
//! one. So it lies below its tangent planes: at any M with `C = M⁻¹` and `Ω = C W C`
//!
//! `1 / tr(W M′⁻¹) ≤ tr(Ω M′) / tr(W C)²`.
//!
//! Hence `Φ(C′) ≥ tr(W C)² / B` where `tr(Ω M′) ≤ B`. For D the same with `det^(1/p)`, and `Ω = C`:
//! `ln det C′ ≥ ln det C − p ln(B/p)`. Both hold for any symmetric C, so that rounding in the inverse of M does
//! no harm.
//!
//! # References
//! `kiefer1960`

use crate::criterion::smooth_criterion::SmoothCriterion;
use calibrant_core::information::Criterion;
use nalgebra::DMatrix;

/// The tangent at a covariance.
pub(crate) struct Tangent<'a> {
    criterion: &'a Criterion,
    /// `Ω`.
    pub(crate) omega: DMatrix<f64>,
    /// `tr(W C)`; for D the value at C.
    at: f64,
}

impl<'a> Tangent<'a> {
    pub(crate) fn new(smooth: SmoothCriterion<'a>, c: &DMatrix<f64>) -> Self {
        let criterion = smooth.criterion;
        let (_, derivative) = smooth.at(c);
        let of_trace_one = |derivative: DMatrix<f64>, scale: &[f64]| {
            let trace: f64 = scale.iter().enumerate().map(|(i, s)| derivative[(i, i)] * s * s).sum();
            derivative / trace
        };
        // the weight W, and for D the inverse of C
        let weight = match criterion {
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => criterion.derivative(c),
            Criterion::D(_) => derivative * c.nrows() as f64,
            Criterion::E(e) => of_trace_one(derivative, e.scale.as_slice()),
            Criterion::M(m) => of_trace_one(derivative, m.scale.as_slice()),
        };
        let at = if let Criterion::D(_) = criterion { criterion.value(c) } else { weight.dot(c) };
        Self { criterion, omega: c * &weight * c, at }
    }

    /// A lower bound of the criterion for every information M′ with `tr(Ω M′)` at most `most`.
    pub(crate) fn bound(&self, most: f64) -> f64 {
        let size = self.omega.nrows() as f64;
        match self.criterion {
            Criterion::D(_) => self.at - size * (most / size).ln(),
            _ => self.at.powi(2) / most,
        }
    }
}
