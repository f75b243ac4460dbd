//! The criteria that a trajectory minimises, as smooth functions of the information.
//!
//! All are in nats: D is `ln det C`, and a mean variance `v` of `r` numbers is `r ln v`. So one unit means the same in all of them, and the search treats them alike.
//! With `v = tr(W C)/r` and `dC = −C dF C`: `dΦ = −tr(Ω dF)`, `Ω = C` for D and `Ω = C W C / v` for the others.

use super::sensor_columns::{ENTRIES, entry};
use calibrant_core::sensor::{ImuQuantity, SensorKind};
use nalgebra::{DMatrix, DVector};

/// What a trajectory minimises.
#[derive(Debug, Clone, PartialEq)]
pub enum TrajectoryCriterion {
    /// D: `ln det C`, a small confidence ellipsoid whatever the units.
    D,
    /// A: the mean variance of the sensor's numbers over its operating range, in units of the noise of one second. Each number counts as the reading that it
    /// changes, `|f_i|` and `|w_i|` within these ranges (m/s², rad/s). The common rotation of both sensors is left out unless the mounting is exact: no motion
    /// determines it, only the mounting's prior does.
    A {
        /// Range of the specific force, m/s², and of the rate, rad/s.
        range: [f64; 2],
    },
    /// c: the weighted mean of variances `Σ w_i C_ii`, with one weight for each parameter.
    C {
        /// The weights.
        weights: Vec<f64>,
    },
    /// I: the mean variance of the corrected readings over the operating range, the common rotation included, in units of the noise of one second.
    I {
        /// Range of the specific force, m/s², and of the rate, rad/s.
        range: [f64; 2],
    },
}

impl TrajectoryCriterion {
    /// Its letter, as in experiment files.
    #[must_use]
    pub fn letter(&self) -> &'static str {
        match self {
            Self::D => "D",
            Self::A { .. } => "A",
            Self::C { .. } => "c",
            Self::I { .. } => "I",
        }
    }
}

/// A criterion for given parameters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Smooth {
    LogDeterminant,
    /// `Φ = r ln(tr(W C)/r)` with `W` and the number `r` of its numbers.
    MeanVariance {
        weight: DMatrix<f64>,
        numbers: usize,
    },
}

impl Smooth {
    /// Of these parameters. `entries` maps them to the 24 entries, `densities` are the noise densities of the sensors.
    pub(crate) fn new(
        criterion: &TrajectoryCriterion,
        quantities: &[ImuQuantity],
        entries: &DMatrix<f64>,
        densities: [Option<f64>; 2],
        mounting_is_exact: bool,
    ) -> Self {
        let of_rows = |rows: Vec<DVector<f64>>| {
            // rows of entries that are no parameters say nothing
            let rows: Vec<DVector<f64>> =
                rows.iter().map(|row| entries.tr_mul(row)).filter(|row| row.amax() > 0.0).collect();
            let mut weight = DMatrix::zeros(entries.ncols(), entries.ncols());
            for row in &rows {
                weight += row * row.transpose();
            }
            Self::MeanVariance { weight, numbers: rows.len() }
        };
        match criterion {
            TrajectoryCriterion::D => Self::LogDeterminant,
            TrajectoryCriterion::A { range } => {
                let both = SensorKind::ALL
                    .iter()
                    .all(|kind| quantities.iter().any(|quantity| quantity.sensor_kind() == *kind));
                of_rows(reading_rows(*range, densities, both && !mounting_is_exact))
            }
            TrajectoryCriterion::I { range } => of_rows(reading_rows(*range, densities, false)),
            TrajectoryCriterion::C { weights } => {
                let diagonal = DVector::from_iterator(entries.ncols(), weights.iter().copied());
                let numbers = weights.iter().filter(|weight| **weight > 0.0).count();
                Self::MeanVariance { weight: DMatrix::from_diagonal(&diagonal), numbers: numbers.max(1) }
            }
        }
    }

    /// Number of its numbers, of `p` parameters.
    pub(crate) fn numbers(&self, p: usize) -> usize {
        match self {
            Self::LogDeterminant => p,
            Self::MeanVariance { numbers, .. } => *numbers,
        }
    }

    /// `Φ` of a covariance; `None` where it is singular.
    pub(crate) fn of_covariance(&self, covariance: &DMatrix<f64>) -> Option<f64> {
        match self {
            Self::LogDeterminant => {
                let scale = covariance.diagonal().map(f64::sqrt);
                let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
                    covariance[(i, j)] / (scale[i] * scale[j])
                });
                let diagonal = scaled.cholesky()?.l_dirty().diagonal();
                Some(2.0 * diagonal.iter().zip(scale.iter()).map(|(l, s)| (l * s).ln()).sum::<f64>())
            }
            Self::MeanVariance { weight, numbers } => {
                let numbers = *numbers as f64;
                Some(numbers * (weight.dot(covariance) / numbers).ln())
            }
        }
    }

    /// `Φ`, the covariance, and `Ω`; `None` where the information is singular.
    pub(crate) fn at(&self, information: &DMatrix<f64>) -> Option<Valued> {
        let scale = information.diagonal().map(|d| 1.0 / d.sqrt());
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let scaled =
            DMatrix::from_fn(scale.len(), scale.len(), |i, j| information[(i, j)] * scale[i] * scale[j]);
        let factor = scaled.cholesky()?;
        let mut covariance = factor.inverse();
        for i in 0..scale.len() {
            for j in 0..scale.len() {
                covariance[(i, j)] *= scale[i] * scale[j];
            }
        }
        let (value, omega) = match self {
            Self::LogDeterminant => {
                let diagonal = factor.l_dirty().diagonal();
                let half: f64 = diagonal.iter().zip(scale.iter()).map(|(l, s)| (l / s).ln()).sum();
                (-2.0 * half, covariance.clone())
            }
            Self::MeanVariance { weight, numbers } => {
                let numbers = *numbers as f64;
                let mean = weight.dot(&covariance) / numbers;
                (numbers * mean.ln(), &covariance * weight * &covariance / mean)
            }
        };
        value.is_finite().then_some(Valued { value, covariance, omega })
    }
}

/// A criterion at an information.
#[derive(Debug, Clone)]
pub(crate) struct Valued {
    pub(crate) value: f64,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) omega: DMatrix<f64>,
}

/// The numbers of A and I: each is a row over the 24 entries. Off the diagonal, a symmetric part and, where `gauge_free`, the rotation of the gyroscope's axes
/// against the accelerometer's; otherwise every entry.
fn reading_rows(range: [f64; 2], densities: [Option<f64>; 2], gauge_free: bool) -> Vec<DVector<f64>> {
    let mut rows = Vec::new();
    let mut row = |terms: &[(usize, f64)]| {
        let mut one = DVector::zeros(ENTRIES);
        for &(place, factor) in terms {
            one[place] += factor;
        }
        rows.push(one);
    };
    let factors =
        [0, 1].map(|s| densities[s].map(|density| (1.0 / density, range[s] / 3.0_f64.sqrt() / density)));
    for (s, factor) in factors.iter().enumerate() {
        let Some((of_bias, of_matrix)) = *factor else { continue };
        for i in 0..3 {
            row(&[(entry(s, i, 0), of_bias)]);
            for j in 0..3 {
                if !gauge_free || i == j {
                    row(&[(entry(s, i, 1 + j), of_matrix)]);
                } else if i < j {
                    let half = of_matrix * std::f64::consts::FRAC_1_SQRT_2;
                    row(&[(entry(s, i, 1 + j), half), (entry(s, j, 1 + i), half)]);
                }
            }
        }
    }
    if let (true, Some((_, of_matrix))) = (gauge_free, factors[1]) {
        let x = of_matrix * std::f64::consts::FRAC_1_SQRT_2;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            row(&[
                (entry(1, i, 1 + j), x),
                (entry(1, j, 1 + i), -x),
                (entry(0, i, 1 + j), -x),
                (entry(0, j, 1 + i), x),
            ]);
        }
    }
    rows
}
