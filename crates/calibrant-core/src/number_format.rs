//! Numbers for people, in tables and in sentences: a value has the digits that its uncertainty leaves it.
//!
//! Tables and pages have a typeset minus and powers of ten: `−1.2 × 10⁻⁵`. Messages, which stand in files too, have the characters of a
//! keyboard ([`plain`]): `-1.2e-5`.

/// The minus sign of typeset numbers.
const MINUS: char = '−';

/// `value ± sd`, both rounded to two significant digits of `sd`: `0.08312 ± 0.00021`.
///
/// A common power of ten is factored out where both are small: `(1.2 ± 0.3) × 10⁻⁵`.
#[must_use]
pub fn with_sd(value: f64, sd: f64) -> String {
    if !value.is_finite() {
        return UNKNOWN.to_string();
    }
    if !sd.is_finite() {
        return format!("{} ± unknown", significant(value, 6));
    }
    if sd <= 0.0 {
        return format!("{} (no uncertainty given)", significant(value, 6));
    }
    let largest = value.abs().max(sd);
    if largest < 1e-3 {
        let exponent = largest.log10().floor() as i32;
        let scale = 10f64.powi(exponent);
        let digits = decimals_for(sd / scale, 2);
        return format!(
            "({} ± {}) × 10{}",
            fixed(value / scale, digits),
            fixed(sd / scale, digits),
            superscript(exponent)
        );
    }
    format!("{} ± {}", rounded_to(value, sd), uncertainty(sd))
}

/// As [`with_sd`]; a value without uncertainty stands alone.
#[must_use]
pub fn with_sd_or_exact(value: f64, sd: f64) -> String {
    if sd > 0.0 { with_sd(value, sd) } else { without_trailing_zeros(&significant(value, 8)) }
}

/// The value rounded to two significant digits of its standard deviation, without it.
#[must_use]
pub fn rounded_to(value: f64, sd: f64) -> String {
    if sd.is_finite() && sd > 0.0 { fixed(value, decimals_for(sd, 2)) } else { significant(value, 6) }
}

/// A standard deviation: two significant digits, as a power of ten where it is small.
#[must_use]
pub fn uncertainty(sd: f64) -> String {
    if sd > 0.0 && sd < 1e-5 { significant(sd, 2) } else { fixed(sd, decimals_for(sd, 2)) }
}

/// The text for a number that is not known or not finite.
pub const UNKNOWN: &str = "–";

/// A number to this many significant digits; powers of ten for the very small and the very large.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return UNKNOWN.to_string();
    }
    if value == 0.0 {
        return "0".to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..7).contains(&exponent) {
        let mantissa = fixed(value / 10f64.powi(exponent), digits.saturating_sub(1));
        return format!("{mantissa} × 10{}", superscript(exponent));
    }
    fixed(value, decimals_for(value, digits))
}

/// A count with its noun: `1 interval`, `10 intervals`.
#[must_use]
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A text with a capital letter first.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A number from a file, such as a nominal value: at most six significant digits, no trailing zeros.
#[must_use]
pub fn short(value: f64) -> String {
    if value == 0.0 { "0".to_string() } else { without_trailing_zeros(&significant(value, 6)) }
}

/// A number in the characters of a keyboard: at most this many significant digits, no trailing zeros.
///
/// # Examples
/// ```
/// use calibrant_core::number_format::plain;
/// assert_eq!([0.100_04, -1234.5, 1.2345e-5].map(|value| plain(value, 3)), ["0.1", "-1230", "1.23e-5"]);
/// ```
#[must_use]
pub fn plain(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A time in a handy unit, with two digits: `0.32 s`, `17 s`, `4.2 min`, `1.5 h`.
#[must_use]
pub fn short_time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", plain(s, 2)),
        s if s < 7200.0 => format!("{} min", plain(s / 60.0, 2)),
        s => format!("{} h", plain(s / 3600.0, 2)),
    }
}

/// A number as an axis shows it: at most six significant digits, no trailing zeros.
#[must_use]
pub fn tick(value: f64) -> String {
    if value.abs() < 1e-12 {
        return "0".to_string();
    }
    without_trailing_zeros(&significant(value, 6))
}

/// A number with its sign, + or −, and this number of decimals. A number that rounds to zero has no sign.
#[must_use]
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    if text.chars().any(|digit| ('1'..='9').contains(&digit)) {
        text.replace('-', &MINUS.to_string())
    } else {
        text[1..].to_owned()
    }
}

/// A probability: two digits, never `0`.
#[must_use]
pub fn probability(p: f64) -> String {
    if !p.is_finite() {
        UNKNOWN.to_string()
    } else if p < 1e-4 {
        "< 0.0001".to_string()
    } else if p > 0.9999 {
        "> 0.9999".to_string()
    } else if !(0.095..=0.99).contains(&p) {
        significant(p, 2).trim_end_matches('.').to_string()
    } else {
        fixed(p, 2)
    }
}

/// A fraction as per cent, two significant digits below 10 %.
#[must_use]
pub fn percent(fraction: f64) -> String {
    if !fraction.is_finite() {
        return UNKNOWN.to_string();
    }
    let value = fraction * 100.0;
    let digits = if value.abs() >= 9.95 { 0 } else { decimals_for(value, 2).min(4) };
    format!("{} %", fixed(value, digits))
}

/// An error angle in degrees to two digits; beyond half a revolution a larger one means nothing more.
#[must_use]
pub fn missed_angle(angle_rad: f64) -> String {
    if angle_rad > std::f64::consts::PI {
        return "more than 180°".into();
    }
    format!("{}°", significant(angle_rad.to_degrees(), 2))
}

/// A whole number with thin spaces between thousands.
#[must_use]
pub fn count(n: usize) -> String {
    let digits = n.to_string();
    if digits.len() <= 4 {
        return digits;
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A number with this many decimals and a typeset minus; never a negative zero.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return UNKNOWN.to_string();
    }
    let text = format!("{:.decimals$}", value.abs());
    let negative = value < 0.0 && text.bytes().any(|b| b.is_ascii_digit() && b != b'0');
    if negative { format!("{MINUS}{text}") } else { text }
}

fn decimals_for(value: f64, digits: usize) -> usize {
    if !value.is_finite() || value == 0.0 {
        return digits;
    }
    let exponent = |v: f64| v.abs().log10().floor() as i32;
    // rounding may carry into the next power of ten: 0.0996 to two digits is 0.10
    let unit = 10f64.powi(exponent(value) - digits as i32 + 1);
    let rounded = (value / unit).round() * unit;
    (digits as i32 - 1 - exponent(rounded + rounded.signum() * unit * 1e-6)).clamp(0, 12) as usize
}

pub(crate) fn without_trailing_zeros(text: &str) -> String {
    match text.split_once(" × ") {
        Some((mantissa, power)) => format!("{} × {power}", trimmed(mantissa)),
        None => trimmed(text).to_string(),
    }
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// An exponent: `⁻⁷`.
#[must_use]
pub fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signed_number_has_a_typeset_minus() {
        assert_eq!(
            [1.23, -1.25, -0.04, 0.0, -10.0].map(|x| signed(x, 1)),
            ["+1.2", "−1.2", "0.0", "0.0", "−10.0"]
        );
    }

    #[test]
    fn a_value_has_the_digits_its_sd_leaves_it() {
        assert_eq!(with_sd(0.083_123_456, 0.000_213), "0.08312 ± 0.00021");
        assert_eq!(with_sd(-33124.18, 0.254), "−33124.18 ± 0.25");
        assert_eq!(with_sd(1.0, 0.0996), "1.00 ± 0.10");
        assert_eq!(with_sd(1.000_123_4, 7.12e-7), "1.00012340 ± 7.1 × 10⁻⁷");
        assert_eq!(with_sd(1.2e-5, 3.4e-6), "(1.20 ± 0.34) × 10⁻⁵");
        assert_eq!(with_sd(12_345.0, 678.0), "12345 ± 678");
    }

    #[test]
    fn degenerate_numbers_are_words_not_nan() {
        assert_eq!(with_sd(f64::NAN, 1.0), "–");
        assert_eq!(with_sd(1.5, f64::INFINITY), "1.50000 ± unknown");
        assert_eq!(with_sd(1.5, 0.0), "1.50000 (no uncertainty given)");
        assert_eq!(significant(f64::INFINITY, 3), "–");
        assert_eq!(fixed(-0.0001, 2), "0.00");
    }

    #[test]
    fn ticks_probabilities_and_counts_are_short() {
        assert_eq!(tick(0.1 + 0.2), "0.3");
        assert_eq!(tick(-2500.0), "−2500");
        assert_eq!(tick(2e-7), "2 × 10⁻⁷");
        assert_eq!(probability(1e-9), "< 0.0001");
        assert_eq!(probability(0.4237), "0.42");
        assert_eq!(percent(0.950_1), "95 %");
        assert_eq!(percent(0.002_13), "0.21 %");
        assert_eq!(count(1_000_000), "1\u{202f}000\u{202f}000");
    }
}
