//! Decimal numbers of Parquet: whole numbers with a number of digits after the point, which the type of the column states.

/// Whole numbers above this are not exact as `f64`.
const EXACT: u128 = 1 << 53;
/// The largest power of ten that is exact as `f64`.
const EXACT_POWER: i32 = 22;

/// The number nearest to `unscaled` × 10^−`scale`.
pub fn decimal(unscaled: i128, scale: i32) -> f64 {
    if unscaled.unsigned_abs() <= EXACT && (0..=EXACT_POWER).contains(&scale) {
        // a quotient of exact numbers is rounded once
        return unscaled as f64 / 10.0_f64.powi(scale);
    }
    format!("{unscaled}e{}", -i64::from(scale)).parse().unwrap_or(f64::NAN)
}

/// A whole number in two's complement, its first byte the highest. `None` where it takes more than 16 bytes, or has none.
pub fn big_endian(bytes: &[u8]) -> Option<i128> {
    let fill = if *bytes.first()? < 0x80 { 0 } else { 0xff };
    let (high, low) = bytes.split_at(bytes.len().saturating_sub(16));
    if high.iter().any(|byte| *byte != fill) || (low[0] ^ fill) >= 0x80 {
        return None;
    }
    let mut whole = [fill; 16];
    whole[16 - low.len()..].copy_from_slice(low);
    Some(i128::from_be_bytes(whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_is_the_number_that_its_digits_say() {
        assert_eq!(decimal(-1234, 4), -0.1234);
        assert_eq!(decimal(981, 0), 981.0);
        assert_eq!(decimal(123_456_789_012_345_678_901_234_567_890, 25), 12_345.678_901_234_567);
        assert_eq!(decimal(5, -3), 5000.0);
    }

    #[test]
    fn bytes_are_a_whole_number_with_a_sign() {
        assert_eq!(big_endian(&[0xff, 0x85]), Some(-123));
        assert_eq!(big_endian(&[0x00, 0x85]), Some(133));
        assert_eq!(big_endian(&[[0xff; 20].as_slice(), &[0x85]].concat()), Some(-123));
        assert_eq!(big_endian(&[[0; 4].as_slice(), &[0x80; 16]].concat()), None);
        assert_eq!(big_endian(&[]), None);
    }
}
