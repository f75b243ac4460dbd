//! Errors over their prediction, as root mean squares, and how many independent numbers are behind the ratio.
//!
//! Each error counts with `w = 1/(mean predicted variance)`, so that well predicted errors are not lost beside others. If the covariance is right,
//! `Σ w |e|²` has the mean `tr C` and the variance `2 tr C²`, with `C` the covariance of all `√w e`. That is χ² with `ν = (tr C)²/tr C²` degrees of freedom,
//! scaled (`satterthwaite1946`). Errors that have the parameters in common are few numbers, however many errors there are.
//! Holds of one orientation count as if they shared their scatter: what the model misses in a pose comes back with the pose.

use super::predicted_error::{Group, Item};
use nalgebra::DMatrix;

/// Variance of the square of an error by knocks beyond that of a normal error, over the latter. Student's distribution of the fit, with five degrees of
/// freedom, has `ν/(ν − 4) − 1 = 4`; half-sines of 5 to 30 ms have longer tails, as those of 4.5 degrees.
pub(super) const KNOCK_TAILS: f64 = 8.0;

/// Errors beside their prediction.
#[derive(Clone, Copy)]
pub(super) struct ErrorRatio {
    /// Root mean square of the lengths, and what was predicted of it.
    pub(super) rms: f64,
    pub(super) predicted_rms: f64,
    /// Independent numbers behind the ratio.
    pub(super) degrees: f64,
    /// Orientations, or rotations, that differ.
    pub(super) distinct: usize,
}

impl ErrorRatio {
    /// Of the errors that count. `None` where there are none.
    pub(super) fn of(groups: &[Group], counts: &[Vec<bool>]) -> Option<Self> {
        let (mut weight, mut square, mut trace, mut squared_trace) = (0.0, 0.0, 0.0, 0.0);
        let mut orientations: Vec<(&Item, DMatrix<f64>)> = Vec::new();
        for (group, counts) in groups.iter().zip(counts) {
            let mut by_parameters = DMatrix::zeros(group.covariance.nrows(), group.covariance.ncols());
            let mut before: Option<(usize, f64)> = None;
            for (number, item) in group.items.iter().enumerate().filter(|(number, _)| counts[*number]) {
                let width = item.error.len() as f64;
                let w = width / item.predicted(&group.covariance).trace();
                weight += w;
                square += w * item.error.norm_squared();
                trace += width;
                let j = &item.by_parameters;
                let own = &item.own * w;
                // of tr C², what noise and parameters have in common
                squared_trace += 2.0 * w * (j * &group.covariance * j.transpose()).dot(&own);
                by_parameters += j.tr_mul(j) * w;
                if let (Some((previous, w_before)), Some(shared)) = (before, &item.with_previous)
                    && previous + 1 == number
                {
                    let j_before = &group.items[previous].by_parameters;
                    let common = j * &group.covariance * j_before.transpose();
                    squared_trace += 2.0 * w * w_before * (shared.norm_squared() + 2.0 * shared.dot(&common));
                }
                before = Some((number, w));
                let scatter = item.scatter_share();
                let of_tails = KNOCK_TAILS * item.knock_share.powi(2);
                squared_trace += (1.0 - scatter * scatter + of_tails) * own.norm_squared();
                let own = own * scatter;
                match orientations.iter_mut().find(|(first, _)| first.place.is_oriented_as(&item.place)) {
                    Some((_, sum)) => *sum += own,
                    None => orientations.push((item, own)),
                }
            }
            let common = &by_parameters * &group.covariance;
            squared_trace += (&common * &common).trace();
        }
        squared_trace += orientations.iter().map(|(_, own)| own.norm_squared()).sum::<f64>();
        (weight > 0.0).then(|| Self {
            rms: (square / weight).sqrt(),
            predicted_rms: (trace / weight).sqrt(),
            degrees: trace * trace / squared_trace,
            distinct: orientations.len(),
        })
    }

    /// The same where squares are this many times their prediction in the mean.
    pub(super) fn of_mean(self, mean: f64) -> Self {
        Self { predicted_rms: self.predicted_rms * mean.sqrt(), ..self }
    }

    /// The same where only this share of the squares is left to chance: something was fitted to the errors.
    pub(super) fn with_share_left(self, share: f64) -> Self {
        Self { degrees: self.degrees * share, ..self.of_mean(share) }
    }
}
