//! Errors beside their prediction: χ², the factor between them, and the errors that stand out.

use super::caveats_of_calibration::Caveats;
use super::chi_square_ratio::{Ratio, falls_to, mean_of_folds};
use super::covariance_verdict::CovarianceVerdict;
use super::error_ratio::{ErrorRatio, KNOCK_TAILS};
use super::predicted_error::{Group, Item};
use super::result::{ParameterPart, ValidatedErrors};
use super::unused_error::{ErrorKind, UnusedError};
use super::whitened_errors::Whitened;
use crate::estimate::imu::KNOCK_DEGREES;
use nalgebra::DVector;

/// An error stands out when one as large as it would be seen in fewer than this share of validations.
const OUTLYING: f64 = 0.01;
/// A direction counts for the parameters' part where they answer for this much of its variance.
const SEEN: f64 = 0.1;

/// What is known of the errors of a kind beside themselves.
pub(super) struct ErrorContext<'a> {
    /// Behind each scatter that is part of their prediction.
    pub(super) scatter_degrees: Vec<Degrees>,
    /// Of folds: what was fitted to the same errors.
    pub(super) folds: Option<Fitted>,
    /// Number of kinds that are judged together.
    pub(super) together: usize,
    /// Is a shift that all have in common free?
    pub(super) free_shift: bool,
    /// What the calibration itself gives reason to doubt.
    pub(super) caveats: &'a Caveats,
}

/// Numbers that were fitted to the errors of folds, all together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted {
    /// Unknowns of the calibration, which the errors of different blocks share.
    pub(super) unknowns: f64,
    /// Numbers that were fitted to all blocks, and that no prediction allows for.
    pub(super) taken: f64,
}

/// Degrees of freedom behind a scatter that is part of a prediction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Degrees {
    pub(super) of_scatter: f64,
    /// Unknowns that are fitted to the same numbers.
    pub(super) unknowns: f64,
    /// The share of the predicted variance that these are behind, where it is known; that of each error otherwise.
    pub(super) share: Option<f64>,
}

impl Degrees {
    /// Of a scatter that so many numbers show beside so many unknowns.
    pub(super) fn of_scatter(numbers: usize, unknowns: usize) -> Self {
        Self { of_scatter: numbers.saturating_sub(unknowns) as f64, unknowns: unknowns as f64, share: None }
    }

    /// Behind a prediction; infinite where the calibration found no scatter.
    fn behind(&self, share: impl FnOnce() -> f64) -> f64 {
        let share = self.share.unwrap_or_else(share);
        if share > 0.0 { self.of_scatter.max(1.0) / share.powi(2) } else { f64::INFINITY }
    }
}

/// Degrees of freedom behind what is predicted of these errors, for each scatter.
pub(super) fn degrees_behind<'a>(
    items: impl Iterator<Item = &'a Item> + Clone,
    scatter_degrees: &[Degrees],
) -> Vec<f64> {
    let count = items.clone().count() as f64;
    let mean = |of: &dyn Fn(&Item) -> f64| items.clone().map(of).sum::<f64>() / count;
    let tails = 1.0 + mean(&|item| KNOCK_TAILS * item.knock_share.powi(2));
    let share = |k: usize| mean(&|item| item.scatters[k].estimated_share());
    scatter_degrees.iter().enumerate().map(|(k, degrees)| degrees.behind(|| share(k)) / tails).collect()
}

/// Judges the errors of one kind. Errors that stand out are put aside, one at a time, a fifth of them at most. `None` where there is no error.
pub(super) fn judge(kind: ErrorKind, groups: &[Group], behind: &ErrorContext<'_>) -> Option<ValidatedErrors> {
    let lengths: Vec<usize> = groups.iter().map(|group| group.items.len()).collect();
    let count: usize = lengths.iter().sum();
    let width = groups.iter().find_map(|group| group.items.first())?.error.len();
    let mut counts: Vec<Vec<bool>> = lengths.iter().map(|length| vec![true; *length]).collect();
    let mut errors = described(groups);
    let knocks: Vec<f64> =
        groups.iter().flat_map(|group| &group.items).map(|item| item.knock_share).collect();
    let (chi2, degrees) = loop {
        let (chi2, degrees) = total(groups, &counts, behind.free_shift)?;
        let kept = errors.iter().filter(|error| error.counts).count();
        let (worst, error) = errors
            .iter()
            .enumerate()
            .filter(|(_, error)| error.counts)
            .max_by(|one, other| one.1.in_sd.total_cmp(&other.1.in_sd))?;
        let own = error.in_sd.powi(2) * width as f64;
        let others = degrees.saturating_sub(width);
        let enough = others > 0 && 5 * (count - kept + 1) <= count;
        let limit = largest_usual(width, others, knocks[worst], OUTLYING / count as f64);
        // beside what was predicted, or beside the others where these are worse
        let scatter = ((chi2 - own) / others.max(1) as f64).max(1.0);
        if !enough || error.in_sd.powi(2) / scatter <= limit {
            break (chi2, degrees);
        }
        errors[worst].counts = false;
        let (mut group, mut within) = (0, worst);
        while within >= lengths[group] {
            within -= lengths[group];
            group += 1;
        }
        counts[group][within] = false;
    };
    if degrees == 0 {
        return None;
    }
    let scatters = degrees_behind(groups.iter().flat_map(|group| &group.items), &behind.scatter_degrees);
    let numbers = width * errors.iter().filter(|error| error.counts).count();
    let found = ErrorRatio::of(groups, &counts)?.with_share_left(degrees as f64 / numbers as f64);
    let (found, ratio) = match behind.folds {
        Some(fitted) => {
            let left = (numbers as f64 - fitted.unknowns).max(1.0);
            let taken = 1.0 - (fitted.taken / left).min(0.5);
            let found = found.of_mean(taken * mean_of_folds(&scatters));
            (found, Ratio::of_folds(found.degrees.min(taken * left)))
        }
        None => (found, Ratio::new(found.degrees, &scatters)),
    };
    let factor = found.rms / found.predicted_rms;
    let (low, high) = ratio.usual(behind.together);
    let factor_interval = (factor / high.sqrt(), factor / low.sqrt());
    let parameters = match groups {
        [group] if behind.folds.is_none() => {
            // the parameters' covariance is as uncertain as the scatter, however small its share is
            let of = |(degrees, all): (&Degrees, &f64)| degrees.share.map_or(*all, |_| degrees.of_scatter);
            let degrees: Vec<f64> = behind.scatter_degrees.iter().zip(&scatters).map(of).collect();
            parameter_part(group, &counts[0], &degrees, behind.together)
        }
        _ => None,
    };
    let mut verdict = CovarianceVerdict::of(factor, factor_interval);
    if matches!(verdict, CovarianceVerdict::Believed | CovarianceVerdict::TooFew)
        && let Some(part) = parameters
        && CovarianceVerdict::of(part.factor, part.factor_interval) == CovarianceVerdict::TooSmall
    {
        verdict = CovarianceVerdict::TooSmall;
    }
    let caveat = behind.caveats.about(kind, &errors);
    if caveat.is_some()
        && matches!(verdict, CovarianceVerdict::Believed | CovarianceVerdict::LargerThanNeeded)
    {
        verdict = CovarianceVerdict::Doubtful;
    }
    Some(ValidatedErrors {
        kind,
        rms: found.rms,
        predicted_rms: found.predicted_rms,
        distinct: found.distinct,
        chi2,
        degrees_of_freedom: degrees,
        p_value: ratio.above(factor.powi(2)),
        factor,
        factor_interval,
        parameters,
        verdict,
        caveat,
        errors,
    })
}

/// The mean square of the components of an error that chance exceeds with this probability, in its predicted variance. `others`: degrees of freedom of those
/// beside it. The errors of knocks follow Student's distribution, with this share in the variance.
fn largest_usual(width: usize, others: usize, knock_share: f64, level: f64) -> f64 {
    let of_knocks = knock_share.powi(2) / KNOCK_DEGREES;
    let degrees = 1.0 / (1.0 / others as f64 + of_knocks);
    Ratio::new(width as f64, &[degrees]).exceeded_with(level) * (1.0 - 2.0 * of_knocks)
}

/// χ² of all groups and its degrees of freedom; a free shift takes its own.
fn total(groups: &[Group], counts: &[Vec<bool>], shift: bool) -> Option<(f64, usize)> {
    let (mut chi2, mut degrees) = (0.0, 0);
    for (group, counts) in groups.iter().zip(counts).filter(|(_, counts)| counts.iter().any(|counts| *counts))
    {
        let whitened = Whitened::of(group, counts)?;
        chi2 += whitened.chi2()?;
        degrees += whitened.len();
        if shift {
            chi2 -= whitened.shift()?.chi2;
            degrees = degrees.saturating_sub(3);
        }
    }
    Some((chi2.max(0.0), degrees))
}

fn described(groups: &[Group]) -> Vec<UnusedError> {
    groups
        .iter()
        .flat_map(|group| group.items.iter().map(|item| (item, item.predicted(&group.covariance))))
        .map(|(item, predicted)| {
            let width = item.error.len() as f64;
            let weighed = predicted
                .clone()
                .cholesky()
                .map_or_else(|| DVector::zeros(item.error.len()), |c| c.solve(&item.error));
            let place = &item.place;
            UnusedError {
                hold: place.hold,
                from_hold: place.from_hold,
                start_s: place.start_s,
                end_s: place.end_s,
                fold: place.fold,
                error: item.error.clone(),
                predicted_sd: predicted.diagonal().map(f64::sqrt),
                in_sd: (item.error.dot(&weighed) / width).sqrt(),
                counts: true,
            }
        })
        .collect()
}

/// The parameters' part: along direction k the squared error `a_k²` has the mean `1 + c λ_k`, with `c = 1` where `Σ` is right. `c` is that for which
/// `Σ a_k²/(1 + c λ_k)` is its mean, the interval that for which it is usual (the Q-profile method, `viechtbauer2007`).
fn parameter_part(
    group: &Group,
    counts: &[bool],
    scatters: &[f64],
    together: usize,
) -> Option<ParameterPart> {
    let mut parts = Whitened::of(group, counts)?.common_parts();
    parts.retain(|part| part.1 > SEEN);
    if parts.is_empty() {
        return None;
    }
    let n = parts.len() as f64;
    let left = |c: f64| parts.iter().map(|(square, share)| square / (1.0 + c * share)).sum::<f64>() / n;
    let scale = |target: f64| falls_to(target, left);
    let ratio = Ratio::new(n, scatters);
    let (low, high) = ratio.usual(together);
    Some(ParameterPart {
        chi2: left(1.0) * n,
        degrees_of_freedom: parts.len(),
        p_value: ratio.above(left(1.0)),
        factor: scale(1.0).sqrt(),
        factor_interval: (scale(high).sqrt(), scale(low).sqrt()),
    })
}
