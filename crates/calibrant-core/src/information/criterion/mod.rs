//! The criteria of optimality that a design minimises, as functions of the covariance `C` of the parameters.
//!
//! | letter | value | asks for |
//! |---|---|---|
//! | A | `trace C` | small variances on average |
//! | D | `ln det C` | a small confidence ellipsoid, whatever the units |
//! | E | `λ_max(C)` | no bad direction |
//! | M | `max_i C_ii` | no bad parameter |
//! | c | `Σ w_i C_ii` | the parameters that matter to you |
//! | I | mean variance of the corrected reading | accurate readings, which is what a sensor is for |
//!
//! A, E, M and c compare variances of different units. Divide the parameters by a `scale` (their datasheet
//! spread) unless you mean their SI values. All fall when information is added, and all are convex in the
//! information.
//!
//! # References
//! `pukelsheim2006`

mod closed_form;
mod i_optimality;

use crate::json_object;
pub use closed_form::{AOptimality, COptimality, DOptimality, EOptimality, MOptimality};
pub use i_optimality::IOptimality;
use nalgebra::{DMatrix, DVector};

/// One of the criteria, for given parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum Criterion {
    /// `trace C`.
    A(AOptimality),
    /// `ln det C`.
    D(DOptimality),
    /// `λ_max(C)`.
    E(EOptimality),
    /// `max_i C_ii`.
    M(MOptimality),
    /// `Σ w_i C_ii`.
    C(COptimality),
    /// Mean variance of the corrected reading.
    I(IOptimality),
}

json_object! {
    /// What is minimised: its letter, and its formula with the covariance C.
    Criterion as of {
        /// Its letter.
        name: of.letter(),
        /// What is minimised or maximised.
        formula: of.formula(),
    }
}

impl Criterion {
    /// Its letter, as in experiment files: `A`, `D`, `E`, `M`, `c`, `I`.
    #[must_use]
    pub fn letter(&self) -> &'static str {
        match self {
            Self::A(_) => "A",
            Self::D(_) => "D",
            Self::E(_) => "E",
            Self::M(_) => "M",
            Self::C(_) => "c",
            Self::I(_) => "I",
        }
    }

    /// Its formula, as text.
    #[must_use]
    pub fn formula(&self) -> &'static str {
        match self {
            Self::A(_) => "trace C",
            Self::D(_) => "ln det C",
            Self::E(_) => "largest eigenvalue of C",
            Self::M(_) => "largest variance",
            Self::C(_) => "weighted sum of variances",
            Self::I(_) => "mean variance of the corrected reading",
        }
    }

    /// The words behind the formula that name the divisors of the parameters. They are empty where a divisor
    /// changes nothing (I), or is part of the weights (c).
    #[must_use]
    pub fn scaling(&self) -> &'static str {
        let scale = match self {
            Self::A(a) => &a.scale,
            Self::D(d) => &d.scale,
            Self::E(e) => &e.scale,
            Self::M(m) => &m.scale,
            Self::C(_) | Self::I(_) => return "",
        };
        if scale.iter().all(|&s| s == 1.0) {
            ", in SI units"
        } else {
            ", each parameter divided by its datasheet spread"
        }
    }

    /// Its value at a covariance.
    #[must_use]
    pub fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        match self {
            Self::A(a) => a.value(covariance),
            Self::D(d) => d.value(covariance),
            Self::E(e) => e.value(covariance),
            Self::M(m) => m.value(covariance),
            Self::C(c) => c.value(covariance),
            Self::I(i) => i.value(covariance),
        }
    }

    /// Its derivative `∂Φ/∂C`, symmetric and positive semidefinite; a subgradient where E and M have a kink.
    #[must_use]
    pub fn derivative(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Self::A(a) => a.derivative(),
            Self::D(d) => d.derivative(covariance),
            Self::E(e) => e.derivative(covariance),
            Self::M(m) => m.derivative(covariance),
            Self::C(c) => c.derivative(),
            Self::I(i) => i.derivative(),
        }
    }

    /// The criterion of the parameters at these places, which share no information with the others.
    #[must_use]
    pub fn restricted(&self, places: &[usize]) -> Self {
        match self {
            Self::A(a) => Self::A(AOptimality { scale: pick(&a.scale, places) }),
            Self::D(d) => Self::D(DOptimality { scale: pick(&d.scale, places) }),
            Self::E(e) => Self::E(EOptimality { scale: pick(&e.scale, places) }),
            Self::M(m) => Self::M(MOptimality { scale: pick(&m.scale, places) }),
            Self::C(c) => Self::C(COptimality { weights: pick(&c.weights, places) }),
            Self::I(i) => Self::I(i.restricted(places)),
        }
    }

    /// The value for all parameters from those of groups that share nothing: the sum, or the largest (E, M).
    #[must_use]
    pub fn combine(&self, parts: impl IntoIterator<Item = f64>) -> f64 {
        match self {
            Self::E(_) | Self::M(_) => parts.into_iter().fold(f64::NEG_INFINITY, f64::max),
            _ => parts.into_iter().sum(),
        }
    }

    /// How much worse `value` is than `best`: `value/best − 1`; for D the difference in nats.
    #[must_use]
    pub fn gap(&self, value: f64, best: f64) -> f64 {
        if let Self::D(_) = self { value - best } else { value / best - 1.0 }
    }
}

fn pick(values: &DVector<f64>, places: &[usize]) -> DVector<f64> {
    DVector::from_iterator(places.len(), places.iter().map(|&place| values[place]))
}

#[cfg(test)]
fn by_hand() -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 2, &[5.0, 2.0, 2.0, 2.0]) // eigenvalues 6 and 1, determinant 6
}
