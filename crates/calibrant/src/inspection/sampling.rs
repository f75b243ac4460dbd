//! The times of samples, in words.

use calibrant_io::Sampling;
use calibrant_report::number_format::{count, short, significant};

/// A line about the times of samples; `what` are the samples of.
pub(super) fn sampling_line(what: &str, sampling: &Sampling) -> String {
    let (start, end) = sampling.span_s;
    // seconds since 1970 hide the duration behind many digits
    let span = match end.abs() < 1e5 {
        true => format!("from {} to {} s", short(start), short(end)),
        false => format!("from {start} s on, over {} s", short(end - start)),
    };
    let gaps = match sampling.gaps {
        0 => "no gaps".to_owned(),
        1 => format!("1 gap of {} s", short(sampling.lost_s)),
        many => format!("{many} gaps, {} s lost", short(sampling.lost_s)),
    };
    let gaps = match sampling.missing > 0.0 {
        true => format!("{} % of the samples missing, {gaps}", significant(100.0 * sampling.missing, 2)),
        false => gaps,
    };
    // a nanosecond is rounding, and so are the last digits of a late time
    let jitter = if sampling.jitter_s < 1e-9_f64.max(f64::EPSILON * end.abs()) {
        "none".into()
    } else {
        format!("{} ms (sd)", significant(1e3 * sampling.jitter_s, 2))
    };
    format!(
        "{what}: {} samples {span}, {} Hz; steps {} to {} ms, jitter {jitter}; {gaps}",
        count(sampling.samples),
        significant(sampling.rate_hz, 5),
        significant(1e3 * sampling.steps_s.0, 4),
        significant(1e3 * sampling.steps_s.1, 4)
    )
}
