//! Sums over all lags of covariances that are smooth but for a few lags, from a few hundred of them.

/// Every lag within this of a kink is summed.
const NEAR: i64 = 16;
/// Beyond, the distance to the kink grows by this factor from lag to lag.
const RATIO: f64 = 1.12;

/// Whole numbers from `first` to `last`: all those near the kinks, ever fewer away from them.
pub(super) fn around(kinks: &[i64], first: i64, last: i64) -> Vec<i64> {
    let offsets: Vec<i64> = (0..=NEAR).chain(far(last - first)).collect();
    let mut kinks = kinks.to_vec();
    kinks.sort_unstable();
    kinks.dedup();
    let mut lags = vec![first];
    for kink in kinks {
        let inside = |lag: &i64| (first..=last).contains(lag);
        lags.extend(offsets.iter().rev().map(|offset| kink - offset).filter(inside));
        lags.extend(offsets.iter().map(|offset| kink + offset).filter(inside));
    }
    lags.push(last);
    // a few runs that rise: what this sort is fast at
    lags.sort();
    lags.dedup();
    lags
}

/// Offsets beyond those that are near, up to the largest.
fn far(largest: i64) -> impl Iterator<Item = i64> {
    let grow = |offset: &f64| Some(offset * RATIO);
    std::iter::successors(Some(NEAR as f64 * RATIO), grow)
        .map(|offset| offset as i64)
        .take_while(move |offset| *offset <= largest)
}

/// Weights under which a sum over some of the lags is the sum over all, the summand being linear in between.
pub(super) fn weights(lags: &[i64]) -> Vec<f64> {
    let mut weights = vec![0.0; lags.len()];
    if let (Some(first), Some(last)) = (lags.first(), lags.last()) {
        weights[0] += 0.5;
        *weights.last_mut().unwrap_or(&mut 0.0) += 0.5;
        debug_assert!(first <= last);
    }
    for (i, pair) in lags.windows(2).enumerate() {
        let half = 0.5 * (pair[1] - pair[0]) as f64;
        weights[i] += half;
        weights[i + 1] += half;
    }
    weights
}

/// Number of pairs `(s, t)`, `0 ≤ s < j`, `0 ≤ t < k`, with `t − s = lag`.
pub(super) fn pairs(j: i64, k: i64, lag: i64) -> f64 {
    (j.min(k - lag) - (-lag).max(0)).max(0) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_functions_are_summed_exactly() {
        let lags = around(&[0, 300], -1000, 5000);
        assert!(lags.len() < 300, "{}", lags.len());
        let weights = weights(&lags);
        let sum =
            |f: &dyn Fn(f64) -> f64| lags.iter().zip(&weights).map(|(&h, w)| w * f(h as f64)).sum::<f64>();
        assert!((sum(&|_| 1.0) - 6001.0).abs() < 1e-9);
        let all: f64 = (-1000..=5000).map(|h: i64| h as f64).sum();
        assert!((sum(&|h| h) - all).abs() < 1e-6);
    }

    #[test]
    fn pairs_are_counted() {
        assert_eq!((-5..=5).map(|lag| pairs(3, 4, lag)).sum::<f64>(), 12.0);
        assert_eq!((pairs(3, 4, 0), pairs(3, 4, 3), pairs(3, 4, -2)), (3.0, 1.0, 1.0));
    }
}
