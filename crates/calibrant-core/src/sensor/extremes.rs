//! The lesser and the greater of two numbers.

/// The lesser of two numbers, the first if they cannot be compared. For what is done with every sample: `f64::min` minds NaN and takes thrice as long.
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
