//! The lesser and the greater of two numbers, and a quantile of values in any order.

/// The lesser of two numbers, the first if they cannot be compared. It serves loops over all samples:
/// `f64::min` handles NaN and takes thrice as long.
#[inline]
#[must_use]
pub fn lesser(one: f64, other: f64) -> f64 {
    if other < one { other } else { one }
}

/// The greater of two numbers, as [`lesser`].
#[inline]
#[must_use]
pub fn greater(one: f64, other: f64) -> f64 {
    if other > one { other } else { one }
}

/// The value that this share of all is below; `None` of none.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    let place = (share * values.len() as f64) as usize;
    (place < values.len()).then(|| *values.select_nth_unstable_by(place, f64::total_cmp).1)
}
