//! The lesser and the greater of two numbers.

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
