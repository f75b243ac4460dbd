//! A sample rate as files state it: with the digits that its times have.

use calibrant_core::sensor::rate_hz;

/// A time step is a gap from this many usual steps on.
pub const GAP: f64 = 5.0;

/// Samples over duration, gaps left out, Hz, with the digits that the times have; 0 for fewer than two.
pub fn measured_rate_hz(times_s: &[f64]) -> f64 {
    let longest_s = GAP / rate_hz(times_s);
    let steps = times_s.array_windows().map(|[one, next]| next - one).filter(|step| *step <= longest_s);
    let (sum, count) = steps.fold((0.0, 0.0), |(sum, count), step| (sum + step, count + 1.0));
    if sum > 0.0 { stated_rate_hz(count / sum, times_s[times_s.len() - 1]) } else { 0.0 }
}

/// The rate with the fewest digits that the rounding of the times allows.
///
/// Times are rounded to bits. A step between them is then wrong by up to `ε t`, with the latest time `t`, and a rate `r` by `r² ε t`. So a
/// rate of 100 Hz does not become 100.00000000000213.
pub fn stated_rate_hz(rate_hz: f64, latest_s: f64) -> f64 {
    let error = rate_hz * rate_hz * f64::EPSILON * latest_s.abs();
    let with_digits = |digits: usize| format!("{rate_hz:.digits$e}").parse::<f64>().ok();
    (0..17).filter_map(with_digits).find(|near| (near - rate_hz).abs() <= error).unwrap_or(rate_hz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nominal_rate_is_stated_as_such_and_a_measured_one_as_it_was_measured() {
        for nominal in [1.0, 50.0, 100.0, 104.0, 833.0, 1000.0, 6667.0] {
            for start in [0.0, 17.3, 5000.0] {
                let times: Vec<f64> = (0..3000).map(|k| start + f64::from(k) / nominal).collect();
                assert_eq!(stated_rate_hz(rate_hz(&times), times[2999]), nominal, "{start}");
            }
        }
        let measured = 104.173_2;
        let times: Vec<f64> = (0..3000).map(|k| f64::from(k) / measured).collect();
        assert_eq!(stated_rate_hz(rate_hz(&times), times[2999]), measured);
        // in whole microseconds, of which the usual step is 833
        let whole: Vec<f64> = (0..3000).map(|k| (f64::from(k) / 1.2e-3).round() * 1e-6).collect();
        assert!((measured_rate_hz(&whole) - 1200.0).abs() < 1e-3, "{}", measured_rate_hz(&whole));
        // a step of 9.600123456 ms has more digits, and they stay
        let rate = 1.0 / 9.600_123_456e-3;
        assert!((stated_rate_hz(rate, 30.0) / rate - 1.0).abs() < 1e-12);
        assert_eq!((stated_rate_hz(0.0, 0.0), stated_rate_hz(f64::INFINITY, 1.0)), (0.0, f64::INFINITY));
    }
}
