//! Errors beside their prediction: χ², the factor between them, and the errors that stand out.
//!
//! Part of a prediction is itself an estimate: the scatter between holds or rotations comes from a few dozen of them. With ν degrees of freedom behind it, and with
//! a share w of the variance, χ²/n is compared with Fisher's F of n and ν/w² degrees of freedom; without such a part that is χ².

use super::item::Group;
use super::result::{CovarianceVerdict, ErrorKind, ParameterPart, UnusedError, ValidatedErrors};
use super::whitened::Whitened;
use nalgebra::DVector;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// Two-sided probability that an honest covariance is doubted.
const SIGNIFICANCE: f64 = 0.01;
/// An error stands out when one as large as it would be seen in fewer than this share of validations.
const OUTLYING: f64 = 0.01;
/// So many degrees of freedom are as good as infinitely many.
const MANY: f64 = 1e5;
/// A direction counts for the parameters' part where they answer for this much of its variance.
const SEEN: f64 = 0.1;

/// χ²/n of an honest covariance.
#[derive(Clone, Copy)]
pub(super) struct Ratio {
    numerator: f64,
    /// Degrees of freedom behind what was estimated.
    denominator: f64,
    /// Its mean, where the distribution is that of χ² about another mean than one.
    mean: f64,
}

impl Ratio {
    /// Of errors that are independent of the scatter behind their prediction: Fisher's F.
    pub(super) fn new(degrees: usize, denominator: f64) -> Self {
        Self { numerator: degrees as f64, denominator, mean: 1.0 }
    }

    /// Of folds: the errors of one block are part of the scatter by which the others are predicted, so that an estimate that is too small here is too large there. What
    /// is left of its uncertainty is the mean of F, `ν/(ν − 2)`.
    fn of_folds(degrees: usize, denominator: f64) -> Self {
        let mean = if denominator.is_finite() {
            denominator / (denominator - 2.0).max(0.5 * denominator)
        } else {
            1.0
        };
        Self { numerator: degrees as f64, denominator: f64::INFINITY, mean }
    }

    /// The probability of a ratio at least this large.
    pub(super) fn above(self, ratio: f64) -> f64 {
        let (n, ratio) = (self.numerator, ratio.max(0.0) / self.mean);
        if self.denominator > MANY {
            return ChiSquared::new(n).map_or(1.0, |distribution| distribution.sf(ratio * n));
        }
        FisherSnedecor::new(n, self.denominator).map_or(1.0, |distribution| distribution.sf(ratio))
    }

    /// The ratio that is exceeded with this probability.
    pub(super) fn exceeded_with(self, probability: f64) -> f64 {
        falls_to(probability, |ratio| self.above(ratio))
    }

    /// Ratios within which an honest covariance stays, but for one case in a hundred.
    fn usual(self) -> (f64, f64) {
        (self.exceeded_with(1.0 - 0.5 * SIGNIFICANCE), self.exceeded_with(0.5 * SIGNIFICANCE))
    }
}

/// Where a falling function of a positive number reaches a value; 0 where it is below from the start.
fn falls_to(value: f64, of: impl Fn(f64) -> f64) -> f64 {
    if of(0.0) <= value {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while of(high) > value && high < 1e12 {
        (low, high) = (high, 4.0 * high);
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if of(middle) > value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// What is known of the errors of a kind beside themselves.
#[derive(Clone, Copy)]
pub(super) struct Behind {
    /// Degrees of freedom behind the scatter that is part of their prediction.
    pub(super) scatter_degrees: f64,
    /// Are they of folds?
    pub(super) folds: bool,
    /// Is a shift that all have in common free?
    pub(super) free_shift: bool,
}

/// Judges the errors of one kind. Errors that stand out are put aside, one at a time, a fifth of them at most. `None` where there is no error.
pub(super) fn judge(kind: ErrorKind, groups: &[Group], behind: Behind) -> Option<ValidatedErrors> {
    let lengths: Vec<usize> = groups.iter().map(|group| group.items.len()).collect();
    let count: usize = lengths.iter().sum();
    let width = groups.iter().find_map(|group| group.items.first())?.error.len();
    let mut counts: Vec<Vec<bool>> = lengths.iter().map(|length| vec![true; *length]).collect();
    let mut errors = described(groups);
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
        let limit = Ratio::new(width, others as f64).exceeded_with(OUTLYING / count as f64);
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
    let kept: Vec<&UnusedError> = errors.iter().filter(|error| error.counts).collect();
    let mean = |of: &dyn Fn(&UnusedError) -> f64| {
        (kept.iter().map(|error| of(error)).sum::<f64>() / kept.len() as f64).sqrt()
    };
    let (rms, predicted_rms) =
        (mean(&|error| error.error.norm_squared()), mean(&|error| error.predicted_sd.norm_squared()));
    let share = groups.iter().flat_map(|group| &group.items).map(|item| item.scatter_share).sum::<f64>()
        / count as f64;
    let denominator =
        if share > 0.0 { behind.scatter_degrees.max(1.0) / share.powi(2) } else { f64::INFINITY };
    let ratio =
        if behind.folds { Ratio::of_folds(degrees, denominator) } else { Ratio::new(degrees, denominator) };
    let found = chi2 / degrees as f64;
    let (low, high) = ratio.usual();
    let factor_interval = ((found / high).sqrt(), (found / low).sqrt());
    let parameters = match groups {
        [group] if !behind.folds => parameter_part(group, &counts[0], denominator),
        _ => None,
    };
    let factor = (found / ratio.mean).sqrt();
    let mut verdict = CovarianceVerdict::of(factor, factor_interval);
    if matches!(verdict, CovarianceVerdict::Believed | CovarianceVerdict::TooFew)
        && let Some(part) = parameters
        && CovarianceVerdict::of(part.factor, part.factor_interval) == CovarianceVerdict::TooSmall
    {
        verdict = CovarianceVerdict::TooSmall;
    }
    Some(ValidatedErrors {
        kind,
        rms,
        predicted_rms,
        chi2,
        degrees_of_freedom: degrees,
        p_value: ratio.above(found),
        factor,
        factor_interval,
        parameters,
        verdict,
        errors,
    })
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
fn parameter_part(group: &Group, counts: &[bool], denominator: f64) -> Option<ParameterPart> {
    let mut parts = Whitened::of(group, counts)?.common_parts();
    parts.retain(|part| part.1 > SEEN);
    if parts.is_empty() {
        return None;
    }
    let n = parts.len() as f64;
    let left = |c: f64| parts.iter().map(|(square, share)| square / (1.0 + c * share)).sum::<f64>() / n;
    let scale = |target: f64| falls_to(target, left);
    let ratio = Ratio::new(parts.len(), denominator);
    let (low, high) = ratio.usual();
    Some(ParameterPart {
        chi2: left(1.0) * n,
        degrees_of_freedom: parts.len(),
        p_value: ratio.above(left(1.0)),
        factor: scale(1.0).sqrt(),
        factor_interval: (scale(high).sqrt(), scale(low).sqrt()),
    })
}
