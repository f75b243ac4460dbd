//! The times of samples, as `inspect` shows them: rate, jitter, gaps.

use calibrant_core::json_object;
use calibrant_core::sensor::{missing, rate_hz};
use calibrant_recording::stated_rate::{GAP, measured_rate_hz};

/// The times of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampling {
    /// Number of samples.
    pub samples: usize,
    /// First and last sample time, s.
    pub span_s: (f64, f64),
    /// Samples over duration, gaps left out, Hz, with the digits that the times have.
    pub rate_hz: f64,
    /// Shortest and longest step without gaps, s.
    pub steps_s: (f64, f64),
    /// Standard deviation of the steps without gaps, s.
    pub jitter_s: f64,
    /// Number of gaps: steps of more than five usual ones.
    pub gaps: usize,
    /// Time that is lost in gaps, s.
    pub lost_s: f64,
    /// Share of the samples that are missing one by one between the gaps; 0 where it is too small to
    /// determine.
    pub missing: f64,
}

impl Sampling {
    /// What there is to say of times, s, that increase: two at least.
    pub(crate) fn of(times_s: &[f64]) -> Self {
        let rate_hz = rate_hz(times_s);
        let usual = 1.0 / rate_hz;
        let (mut steps, mut gaps, mut lost_s) = (Vec::with_capacity(times_s.len()), 0, 0.0);
        for pair in times_s.windows(2) {
            let step = pair[1] - pair[0];
            if step > GAP * usual {
                gaps += 1;
                lost_s += step - usual;
            } else {
                steps.push(step);
            }
        }
        let count = steps.len().max(1) as f64;
        let mean_step = steps.iter().sum::<f64>() / count;
        let variance = steps.iter().map(|step| (step - mean_step).powi(2)).sum::<f64>() / count;
        let bounds = |start: f64, better: fn(f64, f64) -> f64| steps.iter().copied().fold(start, better);
        Self {
            samples: times_s.len(),
            span_s: (times_s[0], times_s[times_s.len() - 1]),
            rate_hz: measured_rate_hz(times_s),
            steps_s: (bounds(f64::INFINITY, f64::min), bounds(0.0, f64::max)),
            jitter_s: variance.sqrt(),
            gaps,
            lost_s,
            missing: missing(times_s, rate_hz, GAP * usual),
        }
    }
}

json_object! {
    /// The times of samples.
    Sampling as of {
        /// Number of samples.
        samples: of.samples,
        start_s: of.span_s.0,
        end_s: of.span_s.1,
        /// Gaps left out, with the digits that the times have.
        rate_hz: of.rate_hz,
        shortest_step_s: of.steps_s.0,
        longest_step_s: of.steps_s.1,
        /// Standard deviation of the steps.
        jitter_s: of.jitter_s,
        /// Number of steps of more than five usual ones.
        gaps: of.gaps,
        /// Time that is lost in gaps.
        lost_s: of.lost_s,
        /// Share of the samples that are missing one by one.
        missing_share: of.missing,
    }
}
