//! The minimum of a function with one minimum.

/// Where a function with one minimum is least between `low` and `high`, after so many steps: each leaves 0.618 of the interval.
pub(crate) fn least(at: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2], steps: usize) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..steps {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        (low, high) = if at(a) < at(b) { (low, b) } else { (a, high) };
    }
    0.5 * (low + high)
}
