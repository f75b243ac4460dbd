//! Plain decimal numbers, fast: what recordings consist of.

/// Most characters of a number that is read here: so many digits fit 64 bits.
const LONGEST: usize = 19;
/// Whole numbers up to this are exact as `f64`.
const EXACT: u64 = 1 << 53;
/// These powers of ten are exact as `f64`.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// A number such as `-9.81` or `3.3108000e+04`; `None` where it is something else, or too long to be read this way: ask the standard library then.
///
/// The value is the nearest `f64`, as the standard library's: digits and power of ten are exact, and one product or quotient of them is rounded once
/// (`clinger1990`).
pub(super) fn decimal(field: &[u8]) -> Option<f64> {
    if field.len() > LONGEST {
        return None;
    }
    let (negative, number) = signed(field);
    let (mut digits, mut count, mut exponent) = (0_u64, 0, 0);
    let mut step = 0;
    for (place, byte) in number.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            digits = 10 * digits + u64::from(digit);
            count += 1;
            exponent -= step;
        } else if *byte == b'.' && step == 0 {
            step = 1;
        } else if matches!(byte, b'e' | b'E') {
            exponent += whole(&number[place + 1..])?;
            break;
        } else {
            return None;
        }
    }
    if count == 0 || digits > EXACT {
        return None;
    }
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { digits as f64 / power } else { digits as f64 * power };
    Some(if negative { -value } else { value })
}

/// Is it negative, and the rest after the sign.
fn signed(field: &[u8]) -> (bool, &[u8]) {
    match field {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, field),
    }
}

/// A whole number of one to three digits.
fn whole(field: &[u8]) -> Option<i32> {
    let (negative, digits) = signed(field);
    if digits.is_empty() || digits.len() > 3 {
        return None;
    }
    let value = digits
        .iter()
        .try_fold(0, |value, byte| byte.is_ascii_digit().then(|| 10 * value + i32::from(byte - b'0')))?;
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_is_that_of_the_standard_library() {
        let mut read = 0;
        let mut check = |text: &str| {
            let standard: f64 = text.parse().expect("a number");
            if let Some(value) = decimal(text.as_bytes()) {
                assert_eq!(value.to_bits(), standard.to_bits(), "{text}");
                read += 1;
            }
        };
        // a linear congruential generator: digits without a pattern
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        for _ in 0..20_000 {
            let (digits, places, exponent) = (next() >> (next() % 50), next() % 12, next() % 40);
            let sign = if digits % 2 == 0 { "-" } else { "" };
            check(&format!("{sign}{digits}"));
            check(&format!("{sign}{digits}e-{exponent}"));
            check(&format!("{sign}{:.*}", places as usize, digits as f64 * 1e-6));
            check(&format!("{:.7e}", digits as f64 * 1e-9));
        }
        for text in [
            "0",
            "-0",
            "+7",
            ".5",
            "5.",
            "00012.50",
            "1E3",
            "9007199254740993",
            "1e22",
            "1e23",
            "3.3108000e+04",
        ] {
            check(text);
        }
        assert!(read > 60_000, "only {read} were read this way");
    }

    #[test]
    fn anything_else_is_left_to_the_standard_library() {
        for text in [
            "", "-", "+", ".", "e5", "1e", "1e+", "1e1.5", "1.2.3", "nan", "inf", "1,5", "1 ", "--1", "0x10",
            "1e0400",
        ] {
            assert_eq!(decimal(text.as_bytes()), None, "{text}");
        }
    }
}
