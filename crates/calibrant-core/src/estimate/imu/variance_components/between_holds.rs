//! The between-hold variance of the gyroscope's means (Paule and Mandel), per axis.
//!
//! Each mean is explained by a constant, by the specific force where asked for, by powers of the temperature and by the Earth's rate.

use crate::estimate::imu::model::{GyroscopeNoise, HoldData};
use crate::estimate::recording_biases::{Recordings, Told};
use crate::sensor::{MeanReading, SensorThermal, ThermalTerm};
use crate::solve::{Trial, excess};
use nalgebra::{DMatrix, DVector, Matrix3xX, Vector3};
use rayon::prelude::*;

/// The means in the holds.
pub(crate) struct Means<'a> {
    /// Of each hold.
    pub(crate) readings: &'a [Option<MeanReading>],
    pub(crate) noise: &'a GyroscopeNoise,
    pub(crate) by: Explanation<'a>,
}

/// What the means in the holds are explained by, beside a constant.
#[derive(Clone)]
pub(crate) struct Explanation<'a> {
    /// The recordings of the holds, where each has a bias of its own.
    pub(crate) recordings: Recordings,
    /// The specific forces, where the gyroscope feels them.
    pub(crate) forces: Option<&'a [Vector3<f64>]>,
    /// What the gyroscope reads of the Earth's turn about the vertical in each hold, where that is known and no force takes it up.
    pub(crate) of_earth: Option<Vec<Vector3<f64>>>,
    /// What the gyroscope reads in each hold of each unknown of the Earth's rate, which are known to be 0 ± 1; empty where they count as scatter.
    pub(crate) by_earth: Vec<Matrix3xX<f64>>,
    /// `τ` of each hold, K.
    pub(crate) tau_k: Vec<f64>,
    /// Terms that are fixed.
    pub(crate) fixed: SensorThermal,
    /// Terms of each axis that are estimated: what they are expected to be, and its inverse variance (0 where nothing is known).
    pub(crate) terms: [Vec<(ThermalTerm, f64, f64)>; 3],
}

/// The scatter between holds that makes χ² equal its degrees of freedom (Paule and Mandel), per axis; each mean is explained by a constant, by the
/// specific force where asked for, by powers of the temperature, which are returned as well, and by the Earth's rate.
pub(crate) fn between_sd(means: &Means<'_>) -> (Vector3<f64>, SensorThermal) {
    let by = &means.by;
    let (mut between, mut thermal) = (Vector3::zeros(), by.fixed);
    let fit = |axis: usize| Regression::new(means, axis).fit();
    let fits: Vec<Option<(f64, DVector<f64>)>> = (0..3).into_par_iter().map(fit).collect();
    for (axis, fit) in fits.into_iter().enumerate() {
        let solution = fit.map(|(sd, solution)| {
            between[axis] = sd;
            solution
        });
        let first = 1 + by.recordings.earlier + by.forces.map_or(0, |_| 3);
        for (k, (term, expected, _)) in by.terms[axis].iter().enumerate() {
            term.add_to(&mut thermal, expected + solution.as_ref().map_or(0.0, |found| found[first + k]));
        }
    }
    (between, thermal)
}

/// The means of one axis as a linear problem: what explains each, its value and its variance.
struct Regression {
    rows: Vec<(DVector<f64>, f64, f64)>,
    /// Inverse variance of each unknown beforehand.
    prior: DVector<f64>,
    /// Number of the unknowns that are of the Earth's rate: the last.
    of_earth: usize,
    degrees: f64,
}

impl Regression {
    fn new(means: &Means<'_>, axis: usize) -> Self {
        let Means { readings, noise, by } = means;
        let terms = &by.terms[axis];
        let rows: Vec<(DVector<f64>, f64, f64)> = readings
            .iter()
            .enumerate()
            .filter_map(|(j, still)| {
                let still = still.as_ref()?;
                let mut row = vec![1.0];
                row.extend(
                    (0..by.recordings.earlier).map(|r| f64::from(u8::from(by.recordings.of_holds[j] == r))),
                );
                if let Some(forces) = by.forces {
                    row.extend(forces[j].iter());
                }
                let tau_k = by.tau_k[j];
                row.extend(terms.iter().map(|(term, ..)| term.power(tau_k)));
                if let Some(by_earth) = by.by_earth.get(j) {
                    row.extend(by_earth.row(axis).iter());
                }
                let expected: f64 = terms.iter().map(|(term, mean, _)| mean * term.power(tau_k)).sum();
                let of_earth = by.of_earth.as_ref().map_or(0.0, |of_earth| of_earth[j][axis]);
                let mean = still.mean[axis] - by.fixed.bias_change(tau_k)[axis] - expected - of_earth;
                Some((DVector::from_vec(row), mean, noise.variance(still.samples)[axis]))
            })
            .collect();
        let unknowns = rows.first().map_or(1, |(row, ..)| row.len());
        let of_earth = by.by_earth.first().map_or(0, Matrix3xX::ncols);
        let mut prior = DVector::zeros(unknowns);
        for (k, (_, _, weight)) in terms.iter().enumerate() {
            prior[unknowns - of_earth - terms.len() + k] = *weight;
        }
        prior.rows_mut(unknowns - of_earth, of_earth).fill(1.0);
        let known = prior.iter().filter(|weight| **weight > 0.0).count();
        let degrees = (rows.len() + known).saturating_sub(unknowns) as f64;
        Self { rows, prior, of_earth, degrees }
    }

    /// The information, its lower triangle, and the right side.
    fn normal_equations(&self, between: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (mut f, mut g) = (DMatrix::from_diagonal(&self.prior), DVector::zeros(self.prior.len()));
        for (row, mean, variance) in &self.rows {
            let weight = 1.0 / (variance + between * between).max(f64::MIN_POSITIVE);
            f.syger(weight, row, row, 1.0);
            g.axpy(weight * mean, row, 1.0);
        }
        (f, g)
    }

    /// χ² and the unknowns. Those of the Earth's rate are the same for all axes and count with what is expected of their squares, `1 − c` with their variance `c`: at this latitude they may be another.
    fn solve(&self, between: f64) -> Option<Trial<DVector<f64>>> {
        let weight = |variance: f64| 1.0 / (variance + between * between).max(f64::MIN_POSITIVE);
        let (f, g) = self.normal_equations(between);
        let factor = f.cholesky()?;
        let solution = factor.solve(&g);
        let others = self.prior.len() - self.of_earth;
        let of_earth: f64 = match self.of_earth {
            0 => 0.0,
            _ => factor.inverse().diagonal().rows(others, self.of_earth).map(|variance| 1.0 - variance).sum(),
        };
        let chi2 = self
            .rows
            .iter()
            .map(|(row, mean, variance)| weight(*variance) * (mean - row.dot(&solution)).powi(2))
            .sum::<f64>();
        let known = solution.rows(0, others).map(|off| off * off).dot(&self.prior.rows(0, others));
        Some(Trial { chi2: chi2 + known + of_earth, degrees_of_freedom: self.degrees, fitted: solution })
    }

    /// What the means tell of the biases in the recordings, the other unknowns marginalised.
    fn of_recordings(&self, earlier: usize) -> Option<Told> {
        let (between, _) = self.fit()?;
        let (mut f, g) = self.normal_equations(between);
        f.fill_upper_triangle_with_lower_triangle();
        let others: Vec<usize> = std::iter::once(0).chain(1 + earlier..f.nrows()).collect();
        let ours: Vec<usize> = (1..=earlier).collect();
        let part = |rows: &[usize], columns: &[usize]| f.select_rows(rows).select_columns(columns);
        let common = part(&others, &ours);
        let explained = part(&others, &others).cholesky()?.solve(&common).transpose();
        let unreduced = part(&ours, &ours);
        Some(Told {
            reference: unreduced.diagonal().max(),
            information: unreduced - &explained * common,
            weighted: g.select_rows(&ours) - explained * g.select_rows(&others),
        })
    }

    /// The scatter between holds with the unknowns; `None` where these are not determined.
    fn fit(&self) -> Option<(f64, DVector<f64>)> {
        let means = || self.rows.iter().map(|(_, mean, _)| *mean);
        let spread = means().fold(f64::MIN, f64::max) - means().fold(f64::MAX, f64::min);
        excess(|_| 0.25 * spread, |between| self.solve(between))
    }
}

/// What the means tell of the biases in the recordings before the last: three rows for each.
pub(crate) fn of_recordings(means: &Means<'_>) -> Option<Told> {
    let earlier = means.by.recordings.earlier;
    let size = 3 * earlier;
    let mut told =
        Told { information: DMatrix::zeros(size, size), weighted: DVector::zeros(size), reference: 0.0 };
    for axis in 0..3 {
        let of_axis = Regression::new(means, axis).of_recordings(earlier)?;
        told.reference = told.reference.max(of_axis.reference);
        for r in 0..earlier {
            told.weighted[3 * r + axis] = of_axis.weighted[r];
            for s in 0..earlier {
                told.information[(3 * r + axis, 3 * s + axis)] = of_axis.information[(r, s)];
            }
        }
    }
    Some(told)
}

/// Gives the holds their gyroscope means with inverse variances.
pub(crate) fn set_gyroscope_means(
    holds: &mut [HoldData],
    readings: &[Option<MeanReading>],
    noise: &GyroscopeNoise,
    between: &Vector3<f64>,
) {
    for (hold, still) in holds.iter_mut().zip(readings) {
        hold.gyroscope = still.map(|still| {
            let variance = noise.variance(still.samples) + between.component_mul(between);
            (still.mean, variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)))
        });
    }
}
