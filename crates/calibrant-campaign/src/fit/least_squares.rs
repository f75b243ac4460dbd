//! Generalised least squares of all parameters over all soaks: each soak's own covariance, and the scatter of the channels.

use super::entry::{Entry, Means};
use super::scatter::{SoakScatter, added_variance};
use super::soak::{SoakCalibration, SoakPath};
use crate::{Campaign, Channel};
use calibrant_core::sensor::ImuQuantity;
use nalgebra::{DMatrix, DVector};

/// What a soak measures: a value for each entry, their covariance without what all soaks share, and that as a root.
#[derive(Clone)]
pub(super) struct Measurement {
    pub(super) values: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) shared: DMatrix<f64>,
    /// The value and the variance of each entry by itself: those, or where the soak leaves parameters open, with what the others say of the rest (`prior`).
    pub(super) one_by_one: (DVector<f64>, DVector<f64>),
}

impl Measurement {
    /// Of a soak, and of its parameters one by one where they rest on other soaks; `None` where it has no covariance.
    pub(super) fn of(
        (soak, one_by_one): (&SoakCalibration, Option<&SoakCalibration>),
        quantities: &[ImuQuantity],
        means: &Means,
    ) -> Option<Self> {
        let mut found = Self::of_all(soak, quantities, means)?;
        if let Some(one_by_one) = one_by_one {
            let each = Self::of_all(one_by_one, quantities, means)?;
            found.one_by_one = (each.values, each.covariance.diagonal());
        }
        Some(found)
    }

    fn of_all(soak: &SoakCalibration, quantities: &[ImuQuantity], means: &Means) -> Option<Self> {
        let imu = &soak.imu;
        let sigma = imu.covariance.as_ref()?;
        let mut values = DVector::zeros(quantities.len());
        let mut jacobian = DMatrix::zeros(quantities.len(), quantities.len());
        for (row, quantity) in quantities.iter().enumerate() {
            let (value, slopes) = means.measured(*quantity, &imu.parameters);
            values[row] = value;
            for (of, slope) in slopes {
                if let Some(column) = quantities.iter().position(|quantity| *quantity == of) {
                    jacobian[(row, column)] += slope;
                }
            }
        }
        let shared = imu
            .shared
            .as_ref()
            .map_or_else(|| DMatrix::zeros(quantities.len(), 0), |of| &jacobian * &of.root);
        let covariance = &jacobian * sigma * jacobian.transpose() - &shared * shared.transpose();
        let covariance = 0.5 * (&covariance + covariance.transpose());
        let one_by_one = (values.clone(), covariance.diagonal());
        Some(Self { values, covariance, shared, one_by_one })
    }
}

/// The coefficients of all entries.
pub(super) struct Solution {
    pub(super) coefficients: DVector<f64>,
    /// Their covariance without what all soaks share.
    pub(super) covariance: DMatrix<f64>,
    /// What one standard deviation of each shared source does to them.
    pub(super) shared: DMatrix<f64>,
    /// Residuals of each soak, and their standard deviations.
    pub(super) residuals: Vec<(DVector<f64>, DVector<f64>)>,
    /// Each soak less what the others predict of it with the same scatter, over the standard deviations; `None` of one that alone determines a coefficient.
    pub(super) left_out: Vec<Option<DVector<f64>>>,
}

/// The problem of all entries.
pub(super) struct Problem<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) channels: &'a [Channel],
    pub(super) entries: &'a [Entry],
    pub(super) scatters: &'a [SoakScatter],
}

impl Problem<'_> {
    /// Number of coefficients.
    fn size(&self) -> usize {
        self.entries.last().map_or(0, |entry| entry.places.end)
    }

    /// What the coefficients make of a soak: a row for each entry.
    fn rows(&self, path: &SoakPath) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(self.entries.len(), self.size());
        for (k, entry) in self.entries.iter().enumerate() {
            let x = self.campaign.x(path.temperature_c);
            let row = self.channels[entry.channel].row(x, path.direction, path.lag_left);
            rows.row_mut(k).columns_mut(entry.places.start, row.len()).copy_from(&row.transpose());
        }
        rows
    }

    /// Covariance of what a soak measures about its rows.
    fn covariance(&self, measurement: &Measurement, path: &SoakPath) -> DMatrix<f64> {
        let mut covariance = measurement.covariance.clone();
        for (k, entry) in self.entries.iter().enumerate() {
            let (channel, scatter) = (&self.channels[entry.channel], &self.scatters[entry.channel]);
            covariance[(k, k)] += added_variance(self.campaign, channel, scatter, path);
        }
        covariance
    }

    /// `None` where coefficients stay open.
    pub(super) fn solve(&self, measurements: &[Measurement], paths: &[SoakPath]) -> Option<Solution> {
        let size = self.size();
        let mut information = DMatrix::zeros(size, size);
        for entry in self.entries {
            let known = self.channels[entry.channel].precision();
            information.view_mut((entry.places.start, entry.places.start), known.shape()).copy_from(&known);
        }
        let mut right = DVector::zeros(size);
        let sources = measurements.first().map_or(0, |of| of.shared.ncols());
        let mut right_shared = DMatrix::zeros(size, sources);
        for (measurement, path) in measurements.iter().zip(paths) {
            let rows = self.rows(path);
            let weighted = self.covariance(measurement, path).cholesky()?.solve(&rows);
            information += rows.transpose() * &weighted;
            right += weighted.tr_mul(&measurement.values);
            right_shared += weighted.tr_mul(&measurement.shared);
        }
        // each coefficient in its own unit
        let scale = information.diagonal().map(|of| of.sqrt().recip());
        let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
        let inverse = scaled.cholesky()?.inverse();
        let covariance = DMatrix::from_fn(size, size, |i, j| inverse[(i, j)] * scale[i] * scale[j]);
        let coefficients = &covariance * right;
        let residuals = measurements.iter().zip(paths).map(|(measurement, path)| {
            let rows = self.rows(path);
            let of_fit = &rows * &covariance * rows.transpose();
            let own = self.covariance(measurement, path);
            let residual = &measurement.values - &rows * &coefficients;
            let left_out = left_out(&residual, &own, &of_fit);
            let variances = own.diagonal() - of_fit.diagonal();
            ((residual, variances.map(|of| of.max(0.0).sqrt())), left_out)
        });
        let (residuals, left_out) = residuals.unzip();
        Some(Solution { shared: &covariance * right_shared, residuals, left_out, coefficients, covariance })
    }

    /// What a solution predicts of a soak that it does not contain.
    pub(super) fn prediction(
        &self,
        solution: &Solution,
        measurement: &Measurement,
        path: &SoakPath,
    ) -> Option<Prediction> {
        let rows = self.rows(path);
        let variances = (&rows * &solution.covariance * rows.transpose()).diagonal()
            + self.covariance(measurement, path).diagonal();
        let off = &measurement.values - &rows * &solution.coefficients;
        Some(Prediction {
            deviations: off.zip_map(&variances, |off, variance| off / variance.sqrt()),
            coefficients: solution.coefficients.clone(),
            variances: solution.covariance.diagonal(),
        })
    }
}

/// The residual of a fit without this measurement, over its standard deviation: with `R = C − F Σ Fᵀ` it is `C R⁻¹ e`, of covariance `C R⁻¹ C`.
fn left_out(residual: &DVector<f64>, own: &DMatrix<f64>, of_fit: &DMatrix<f64>) -> Option<DVector<f64>> {
    /// What is left of a variance.
    const LEFT: f64 = 1e-6;
    let root = own.clone().cholesky()?;
    let whitened = root.l().solve_lower_triangular(of_fit)?;
    let whitened = root.l().solve_lower_triangular(&whitened.transpose())?;
    let left = DMatrix::identity(own.nrows(), own.nrows()) - whitened;
    if left.symmetric_eigenvalues().min() < LEFT {
        return None;
    }
    let weights = (own - of_fit).cholesky()?.solve(own);
    let variances = (own * &weights).diagonal();
    Some(weights.tr_mul(residual).zip_map(&variances, |of, variance| of / variance.sqrt()))
}

/// A soak beside what the others predict of it.
pub(super) struct Prediction {
    /// Over their standard deviations.
    pub(super) deviations: DVector<f64>,
    /// Coefficients of the others, and their variances.
    pub(super) coefficients: DVector<f64>,
    pub(super) variances: DVector<f64>,
}
