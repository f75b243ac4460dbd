//! Wald tests of one channel: hysteresis, lag, a drift over the campaign, and what lies above the reported order.

use super::scatter::{AxisData, AxisFit, SoakScatter, added_variance, rows};
use super::soak::SoakPath;
use crate::{Campaign, Channel};
use calibrant_core::estimate::chi2_p_value;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Information scaled to a diagonal of ones is singular below this eigenvalue.
const SINGULAR: f64 = 1e-8;

/// A part of a channel's coefficients without its prior.
#[derive(Debug, Clone, PartialEq)]
pub struct WaldTest {
    /// Probability of as much by chance, over the axes.
    pub p_value: f64,
    /// The part of each axis.
    pub estimates: Vec<DVector<f64>>,
}

/// A channel with its data.
pub(super) struct ChannelData<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) channel: &'a Channel,
    pub(super) axes: &'a [AxisData],
    pub(super) paths: &'a [SoakPath],
    pub(super) scatter: &'a SoakScatter,
}

impl ChannelData<'_> {
    fn hysteresis(&self) -> Range<usize> {
        let first = self.channel.polynomial();
        first..first + self.channel.hysteresis_sd.len()
    }

    fn lag(&self) -> Range<usize> {
        self.hysteresis().end..self.channel.coefficients()
    }

    /// Is there hysteresis? `None` where the soaks do not determine it.
    pub(super) fn hysteresis_test(&self) -> Option<WaldTest> {
        self.without_prior(self.hysteresis())
    }

    /// Does the thermometer lag?
    pub(super) fn lag_test(&self) -> Option<WaldTest> {
        self.without_prior(self.lag())
    }

    /// The greatest half difference of the branches, over range and axes, by the fitted coefficients of each axis: estimates without their prior are too large where
    /// they are seen just so.
    pub(super) fn half_difference(&self, coefficients: &[DVector<f64>]) -> f64 {
        let of_axis = |c: &DVector<f64>| c.rows_range(self.hysteresis()).into_owned();
        let estimates: Vec<DVector<f64>> = coefficients.iter().map(of_axis).collect();
        let steps = (-50..=50).map(|k| f64::from(k) / 50.0);
        let of = |(h, x): (&DVector<f64>, f64)| {
            let shape: f64 = (0..h.len()).map(|k| h[k] * x.powi(k as i32)).sum();
            (0.5 * (1.0 - x * x) * shape).abs()
        };
        steps.flat_map(|x| estimates.iter().map(move |h| of((h, x)))).fold(0.0, f64::max)
    }

    /// The greatest error at the rate of the ramps, by the fitted coefficients of each axis.
    pub(super) fn at_ramp(&self, coefficients: &[DVector<f64>]) -> f64 {
        let estimates: Vec<DVector<f64>> =
            coefficients.iter().map(|c| c.rows_range(self.lag()).into_owned()).collect();
        let ends = [-1.0, 1.0];
        let of =
            |(l, x): (&DVector<f64>, f64)| (0..l.len()).map(|k| l[k] * x.powi(k as i32)).sum::<f64>().abs();
        ends.iter().flat_map(|x| estimates.iter().map(move |l| of((l, *x)))).fold(0.0, f64::max)
    }

    /// The lag of the thermometer, s: the ratio of the first lag coefficient and the slope in the middle, by least squares over the axes. `None` where the axes
    /// do not agree: a thermometer lags them all alike.
    pub(super) fn lag_s(&self, test: &WaldTest) -> Option<f64> {
        let [low, high] = self.campaign.range_c;
        /// The share of the squares that may be left.
        const LEFT: f64 = 0.1;
        let (mut product, mut square, mut of_lag) = (0.0, 0.0, 0.0);
        for (fit, l) in self.fits(&self.channel.precision(), self.axes)?.iter().zip(&test.estimates) {
            let c = fit.information.clone().cholesky()?.solve(&fit.right);
            // P_1' = 1, P_3' = −3/2 and P_5' = 15/8 in the middle
            let slope_of_x =
                [(1, 1.0), (3, -1.5), (5, 1.875)].into_iter().filter(|(m, _)| *m < self.channel.polynomial());
            let slope_per_k = slope_of_x.map(|(m, slope)| slope * c[m]).sum::<f64>() * 2.0 / (high - low);
            product += l[0] * slope_per_k;
            square += slope_per_k.powi(2);
            of_lag += l[0].powi(2);
        }
        let per_ramp_min = product / square;
        let agree = of_lag - product * per_ramp_min <= LEFT * of_lag;
        Some(60.0 * per_ramp_min / self.campaign.ramp_k_per_min).filter(|lag| agree && *lag > 0.0)
    }

    /// Probability of what lies above an order by the priors of it; `None` where nothing lies above.
    pub(super) fn beyond_p_value(&self, order: usize) -> Option<f64> {
        let above = order + 1..self.channel.polynomial();
        let (mut chi2, mut count) = (0.0, 0);
        for fit in self.fits(&self.channel.precision(), self.axes)? {
            let covariance = fit.information.cholesky()?.inverse();
            let c = &covariance * &fit.right;
            for m in above.clone() {
                // a shrunken estimate varies by its prior less its own variance
                let variance = self.channel.spread[m]?.powi(2) - covariance[(m, m)];
                chi2 += c[m].powi(2) / variance.max(f64::MIN_POSITIVE);
                count += 1;
            }
        }
        chi2_p_value(chi2, count)
    }

    /// Do the other soaks predict each soak better without the coefficients of this order? `None` where a soak alone determines a coefficient.
    pub(super) fn is_better_without(&self, order: usize) -> Option<bool> {
        let (rows, known) = (rows(self.campaign, self.channel, self.paths), self.channel.precision());
        let with = self.left_out(&rows, &known)?;
        let without =
            self.left_out(&rows.remove_column(order), &known.remove_row(order).remove_column(order))?;
        Some(without < with)
    }

    /// The squares of each soak less what the others predict of it, with the same scatter and over its variance, over the axes.
    fn left_out(&self, rows: &DMatrix<f64>, known: &DMatrix<f64>) -> Option<f64> {
        /// What is left of a variance.
        const LEFT: f64 = 1e-6;
        let added = self.added();
        let mut squares = 0.0;
        for data in self.axes {
            let fit = AxisFit::of(rows, known, data, &added)?;
            let covariance = fit.information.cholesky()?.inverse();
            let residuals = &data.values - rows * (&covariance * &fit.right);
            for (j, residual) in residuals.iter().enumerate() {
                let variance = data.variances[j] + added[j];
                let left = 1.0 - (rows.row(j) * &covariance * rows.row(j).transpose())[0] / variance;
                squares += (left > LEFT).then(|| (residual / left).powi(2) / variance)?;
            }
        }
        Some(squares)
    }

    /// A drift from the first soak to the last, whose estimates are the whole change.
    pub(super) fn drift_test(&self) -> Option<WaldTest> {
        let count = self.paths.len();
        let rows = rows(self.campaign, self.channel, self.paths);
        let in_time = DVector::from_fn(count, |j, _| j as f64 / (count.max(2) - 1) as f64 - 0.5);
        let size = rows.ncols();
        let rows = rows.insert_column(size, 0.0);
        let rows =
            DMatrix::from_fn(count, size + 1, |j, k| if k == size { in_time[j] } else { rows[(j, k)] });
        let known = self.channel.precision().insert_row(size, 0.0).insert_column(size, 0.0);
        self.test(&rows, &known, size..size + 1)
    }

    fn without_prior(&self, part: Range<usize>) -> Option<WaldTest> {
        let mut known = self.channel.precision();
        for k in part.clone() {
            known[(k, k)] = 0.0;
        }
        self.test(&rows(self.campaign, self.channel, self.paths), &known, part)
    }

    fn fits(&self, known: &DMatrix<f64>, axes: &[AxisData]) -> Option<Vec<AxisFit>> {
        let rows = rows(self.campaign, self.channel, self.paths);
        axes.iter().map(|data| AxisFit::of(&rows, known, data, &self.added())).collect()
    }

    fn added(&self) -> Vec<f64> {
        let of = |path| added_variance(self.campaign, self.channel, self.scatter, path);
        self.paths.iter().map(of).collect()
    }

    fn test(&self, rows: &DMatrix<f64>, known: &DMatrix<f64>, part: Range<usize>) -> Option<WaldTest> {
        if part.is_empty() {
            return None;
        }
        let (mut chi2, mut estimates) = (0.0, Vec::new());
        for data in self.axes {
            let fit = AxisFit::of(rows, known, data, &self.added())?;
            let scale = fit.information.diagonal().map(|of| of.sqrt().recip());
            let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
                fit.information[(i, j)] * scale[i] * scale[j]
            });
            if scaled.symmetric_eigenvalues().min() < SINGULAR {
                return None;
            }
            let covariance = fit.information.cholesky()?.inverse();
            let found = (&covariance * &fit.right).rows_range(part.clone()).into_owned();
            let of_part = covariance.view((part.start, part.start), (part.len(), part.len())).into_owned();
            chi2 += found.dot(&of_part.cholesky()?.solve(&found));
            estimates.push(found);
        }
        Some(WaldTest { p_value: chi2_p_value(chi2, part.len() * self.axes.len())?, estimates })
    }
}
