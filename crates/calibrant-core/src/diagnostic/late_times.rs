//! A time offset of the gyroscope, and its correction, in words.

/// `12.3 ms later`.
#[must_use]
pub fn late(offset_s: f64, digits: usize) -> String {
    format!("{:.digits$} ms {}", 1e3 * offset_s.abs(), if offset_s > 0.0 { "later" } else { "earlier" })
}

/// How to correct the gyroscope's times.
///
/// `first_s`: how late the first sample is, s. `skew`: how much later the times become in each second.
#[must_use]
pub fn repair(first_s: f64, skew: f64, digits: usize) -> String {
    let shift = match first_s > 0.0 {
        true => format!("subtract {first_s:.digits$} s from"),
        false => format!("add {:.digits$} s to", -first_s),
    };
    if skew == 0.0 {
        return format!("{shift} the gyroscope's times");
    }
    let factor =
        format!("multiply the time since the gyroscope's first sample by {:.*}", digits + 3, 1.0 - skew);
    let is_little = first_s.abs() < 0.5 * 10.0_f64.powi(-(digits as i32));
    if is_little { factor } else { format!("{factor}, and {shift} its times") }
}
