//! Huber's weight of a sample (`huber1981`).

/// Residuals up to this many standard deviations keep their full weight.
const HUBER: f64 = 4.0;

/// Square root of the weight of a whitened residual, and its part of the cost `2ρ`.
pub(crate) fn huber(whitened: f64) -> (f64, f64) {
    let size = whitened.abs();
    if size <= HUBER {
        (1.0, whitened * whitened)
    } else {
        ((HUBER / size).sqrt(), HUBER * (2.0 * size - HUBER))
    }
}
