//! Numbers and times in sentences about noise.

/// A time in a handy unit, with two digits: `0.32 s`, `17 s`, `4.2 min`, `1.5 h`.
pub(super) fn short_time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", two_digits(s)),
        s if s < 7200.0 => format!("{} min", two_digits(s / 60.0)),
        s => format!("{} h", two_digits(s / 3600.0)),
    }
}

pub(super) fn two_digits(value: f64) -> String {
    format!("{value:.1e}").parse::<f64>().map_or_else(|_| value.to_string(), |rounded| rounded.to_string())
}

pub(super) fn three_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}
