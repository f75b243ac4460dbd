//! Sums of smooth covariances over all lags, from a few hundred of the lags. Only kinks need every lag.

/// Every lag within this distance of a kink is summed.
const NEAR_LAGS: i64 = 16;
/// Beyond, the step from lag to lag is this share of the distance to the nearest kink.
const STEP: f64 = 0.08;

/// Whole numbers from `first` to `last`: all those near the kinks, and ever fewer away from them.
pub(super) fn around(kinks: &[i64], first: i64, last: i64) -> Vec<i64> {
    let mut kinks = kinks.to_vec();
    kinks.sort_unstable();
    let mut lags = vec![first];
    let (mut lag, mut next) = (first, 0);
    while lag < last {
        while kinks.get(next).is_some_and(|kink| *kink <= lag) {
            next += 1;
        }
        let after = next.checked_sub(1).map_or(last - first, |before| lag - kinks[before]);
        let ahead = kinks.get(next).map_or(last - first, |kink| kink - lag);
        let step = ((after.min(ahead) as f64 * STEP) as i64).max(1);
        let is_near = after < NEAR_LAGS || ahead <= NEAR_LAGS;
        // no further than to where the next kink is near
        lag = if is_near { lag + 1 } else { (lag + step.min(ahead - NEAR_LAGS)).min(last) };
        lags.push(lag);
    }
    lags
}

/// Weights that turn a sum over some of the lags into the sum over all, for a summand that is linear in
/// between.
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
