//! One channel by itself: its axes, and the scatter between soaks by restricted maximum likelihood (`patterson1971`).
//!
//! The axes share `ω` and `r`. Variances of a soak are `ω² + (r l e)²` and that of its calibration. The prior of `ω` is half normal with three times the stated
//! `soak_sd`, that of `r` with three times `lag_scatter`.

use super::soak::SoakPath;
use crate::golden_section::least;
use crate::{Campaign, Channel};
use calibrant_core::sensor::legendre;
use nalgebra::{DMatrix, DVector};

/// The priors are so many times as wide as what is stated.
const WIDER: f64 = 3.0;
/// So many soaks more than coefficients determine the scatter.
const MORE_SOAKS: usize = 3;
/// Waits differ where the shares of the lag that are left do by this much.
const DIFFERING_LAG: f64 = 0.3;
/// The largest share of the lag's error that may differ from soak to soak.
const MOST_SCATTER: f64 = 2.0;
/// Steps of a golden section.
const STEPS: usize = 30;
/// Rounds of the two searches in turn.
const ROUNDS: usize = 4;

/// What does not average within a soak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoakScatter {
    /// `ω`, in the channel's unit.
    pub soak_sd: f64,
    /// `r`, the share of the lag's error that differs from soak to soak.
    pub lag_scatter: f64,
    /// Was `ω` found from the soaks? Otherwise it is as stated.
    pub found: bool,
    /// Residuals less coefficients over all axes.
    pub residuals: f64,
    /// Degrees of freedom of the polynomial's variance by what was found (`satterthwaite1946`); infinite where the scatter is as stated.
    pub degrees: f64,
}

/// The measurements of one axis: a value and its variance for each soak.
pub(super) struct AxisData {
    pub(super) values: DVector<f64>,
    pub(super) variances: DVector<f64>,
}

/// The fit of one axis with a given scatter.
pub(super) struct AxisFit {
    /// `Fᵀ V⁻¹ F + Λ`.
    pub(super) information: DMatrix<f64>,
    /// `Fᵀ V⁻¹ q`.
    pub(super) right: DVector<f64>,
    /// −2 log of the restricted likelihood, up to a constant.
    value: f64,
    /// Coefficients that the data determine.
    determined: f64,
}

/// The rows of the soaks.
pub(super) fn rows(campaign: &Campaign, channel: &Channel, paths: &[SoakPath]) -> DMatrix<f64> {
    let rows: Vec<_> = paths
        .iter()
        .map(|path| channel.row(campaign.x(path.temperature_c), path.direction, path.lag_left).transpose())
        .collect();
    DMatrix::from_rows(&rows)
}

/// What a channel adds to the variance of a soak.
pub(super) fn added_variance(
    campaign: &Campaign,
    channel: &Channel,
    scatter: &SoakScatter,
    path: &SoakPath,
) -> f64 {
    let lag = channel.lag_sd.first().map_or(0.0, |sd| scatter.lag_scatter * sd * path.lag_left);
    // from an unknown side the branches are a scatter
    let branch = match (path.direction == 0.0, channel.hysteresis_sd.first()) {
        (true, Some(sd)) => 0.5 * sd * (1.0 - campaign.x(path.temperature_c).powi(2)).max(0.0),
        _ => 0.0,
    };
    scatter.soak_sd.powi(2) + lag.powi(2) + branch.powi(2)
}

impl AxisFit {
    /// `None` where a coefficient stays open.
    pub(super) fn of(
        rows: &DMatrix<f64>,
        known: &DMatrix<f64>,
        data: &AxisData,
        added: &[f64],
    ) -> Option<Self> {
        let variances = DVector::from_fn(added.len(), |j, _| data.variances[j] + added[j]);
        let weighted = DMatrix::from_fn(rows.nrows(), rows.ncols(), |j, k| rows[(j, k)] / variances[j]);
        let of_data = weighted.transpose() * rows;
        let information = &of_data + known;
        let right = weighted.transpose() * &data.values;
        let factor = information.clone().cholesky()?;
        let c = factor.solve(&right);
        let residuals = &data.values - rows * &c;
        let chi2: f64 = (0..added.len()).map(|j| residuals[j].powi(2) / variances[j]).sum();
        let value = chi2 + c.dot(&(known * &c)) + factor.ln_determinant() + variances.map(f64::ln).sum();
        let determined = factor.solve(&of_data).trace();
        value.is_finite().then_some(Self { information, right, value, determined })
    }
}

/// The scatter of a channel; `None` where a coefficient stays open.
pub(super) fn scatter(
    campaign: &Campaign,
    channel: &Channel,
    axes: &[AxisData],
    paths: &[SoakPath],
) -> Option<SoakScatter> {
    let (rows, known) = (rows(campaign, channel, paths), channel.precision());
    let stated = SoakScatter {
        soak_sd: channel.soak_sd,
        lag_scatter: channel.lag_scatter,
        found: false,
        residuals: f64::INFINITY,
        degrees: f64::INFINITY,
    };
    if axes.is_empty() {
        return Some(stated);
    }
    let fits = |scatter: &SoakScatter| -> Option<Vec<AxisFit>> {
        let added: Vec<f64> =
            paths.iter().map(|path| added_variance(campaign, channel, scatter, path)).collect();
        axes.iter().map(|data| AxisFit::of(&rows, &known, data, &added)).collect()
    };
    let residuals = |scatter: &SoakScatter| {
        let fits = fits(scatter)?;
        Some(fits.iter().map(|fit| paths.len() as f64 - fit.determined).sum::<f64>())
    };
    let others = channel.coefficients() - channel.polynomial();
    if paths.len() < channel.free() + others + MORE_SOAKS {
        return Some(SoakScatter { residuals: residuals(&stated)?, ..stated });
    }
    let half_normal =
        |value: f64, stated: f64| if stated > 0.0 { (value / (WIDER * stated)).powi(2) } else { 0.0 };
    let value = |scatter: &SoakScatter| {
        let of_axes = fits(scatter).map_or(f64::INFINITY, |fits| fits.iter().map(|fit| fit.value).sum());
        of_axes
            + half_normal(scatter.soak_sd, channel.soak_sd)
            + half_normal(scatter.lag_scatter, channel.lag_scatter)
    };
    let mut variances: Vec<f64> = axes.iter().flat_map(|axis| axis.variances.iter().copied()).collect();
    variances.sort_by(f64::total_cmp);
    let median_sd = variances.get(variances.len() / 2).copied().unwrap_or_default().sqrt();
    let top = 10.0 * channel.soak_sd.max(median_sd);
    let left = paths.iter().map(|path| path.lag_left);
    let spread = left.clone().fold(0.0, f64::max) - left.fold(f64::INFINITY, f64::min);
    let waits_differ = !channel.lag_sd.is_empty() && spread > DIFFERING_LAG;
    let mut found = SoakScatter { found: true, ..stated };
    for _ in 0..if waits_differ { ROUNDS } else { 1 } {
        found.soak_sd = least(|soak_sd| value(&SoakScatter { soak_sd, ..found }), [0.0, top], STEPS);
        if waits_differ {
            found.lag_scatter =
                least(|lag_scatter| value(&SoakScatter { lag_scatter, ..found }), [0.0, MOST_SCATTER], STEPS);
        }
    }
    // a golden section ends beside the edge
    let none = SoakScatter { soak_sd: 0.0, ..found };
    if value(&none) <= value(&found) {
        found = none;
    }
    let residuals = residuals(&found)?;
    let degrees =
        degrees_of_variance((campaign, channel), (&rows, &known, axes), (paths, &found), waits_differ);
    Some(SoakScatter { residuals, degrees: degrees.unwrap_or(residuals), ..found })
}

/// `2 V²/Var V` of `V`, the mean variance of the polynomial over range and axes: `Var V = gᵀ I⁻¹ g` with the slopes `g` by `ω²` and `r²` and the information
/// `I = ½ Σ tr(P D P D)` of the restricted likelihood, `P = V⁻¹ − V⁻¹ F M⁻¹ Fᵀ V⁻¹`.
fn degrees_of_variance(
    (campaign, channel): (&Campaign, &Channel),
    (rows, known, axes): (&DMatrix<f64>, &DMatrix<f64>, &[AxisData]),
    (paths, scatter): (&[SoakPath], &SoakScatter),
    with_lag: bool,
) -> Option<f64> {
    let lag = |path: &SoakPath| channel.lag_sd.first().map_or(0.0, |sd| (sd * path.lag_left).powi(2));
    let by_lag = with_lag.then(|| DVector::from_iterator(paths.len(), paths.iter().map(lag)));
    let by: Vec<DVector<f64>> = std::iter::once(DVector::repeat(paths.len(), 1.0)).chain(by_lag).collect();
    let size = by.len();
    let (mut mean, mut slopes) = (0.0, DVector::<f64>::zeros(size));
    let mut information = DMatrix::zeros(size, size);
    for data in axes {
        let variances = paths
            .iter()
            .enumerate()
            .map(|(j, path)| data.variances[j] + added_variance(campaign, channel, scatter, path));
        let weights = DVector::from_iterator(paths.len(), variances.map(f64::recip));
        let weighted = DMatrix::from_fn(rows.nrows(), rows.ncols(), |j, k| rows[(j, k)] * weights[j]);
        let covariance = (weighted.transpose() * rows + known).cholesky()?.inverse();
        // what one soak adds to the coefficients
        let gains = &weighted * &covariance;
        let left = DMatrix::from_diagonal(&weights) - &gains * weighted.transpose();
        let over_range = |of: &dyn Fn(usize) -> f64| -> f64 {
            (0..channel.polynomial()).map(|m| legendre::mean_square(m) * of(m)).sum()
        };
        mean += over_range(&|m| covariance[(m, m)]);
        for (a, one) in by.iter().enumerate() {
            slopes[a] += over_range(&|m| (0..paths.len()).map(|j| gains[(j, m)].powi(2) * one[j]).sum());
            for (b, other) in by.iter().enumerate() {
                information[(a, b)] += 0.5 * one.dot(&(left.map(|of| of * of) * other));
            }
        }
    }
    let variance = slopes.dot(&information.cholesky()?.solve(&slopes));
    Some(2.0 * mean * mean / variance)
}
