//! The segment of a recording whose noise is examined: at rest, at equal intervals, without a gap.

use crate::error::{Error, InputError, Refusal, Result};
use crate::sensor::{Recording, missing, rate_hz};
use std::ops::Range;

/// A time step is a gap from this many usual steps on,
pub(super) const GAP: f64 = 5.0;
/// Largest share of missing samples between gaps. Above it, each missing sample is a gap.
const MISSING: f64 = 0.1;
/// A step of this many usual ones is a gap where many samples are missing: one sample is missing there.
const STEP: f64 = 1.5;
/// Fewest samples.
const FEWEST: usize = 96;

/// Samples without a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// First sample (index into the recording).
    pub first: usize,
    /// One past the last sample.
    pub end: usize,
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Time of the last sample, s.
    pub end_s: f64,
    /// Mean time between samples, s.
    pub interval_s: f64,
    /// Largest deviation of a time step from the mean, relative to it.
    pub jitter: f64,
    /// Share of the samples that is missing; 0 where it is too small to determine.
    pub missing: f64,
    /// Number of parts into which gaps divide the requested interval. This is the longest part.
    pub parts: usize,
}

impl Segment {
    /// The longest segment without a gap between these times in s.
    ///
    /// Missing samples shift all later ones against the clusters, so a gap ends a segment. A gap is five
    /// missing samples, or one where more than 10 % are missing. Around fewer missing samples, the remaining
    /// ones count as successive, with `interval_s` as their mean distance. N is then that of the recorded
    /// samples. Jitter of the sample times averages out and is only reported.
    ///
    /// # Errors
    /// [`Error::Experiment`] for times that are not numbers, in the wrong order, or outside the recording.
    /// [`Error::Recording`] where the recording has fewer than 96 samples there.
    pub fn between(recording: &Recording, start_s: f64, end_s: f64) -> Result<Self> {
        check(recording, start_s, end_s)?;
        let Range { start: first, end } = recording.between(start_s, end_s);
        let times = &recording.times_s[first..end];
        let rate = rate_hz(times);
        let lacks = |times: &[f64]| missing(times, rate, GAP / rate);
        let gap_s = if lacks(times) > MISSING { STEP } else { GAP } / rate;
        let mut edges = vec![0];
        edges.extend((1..times.len()).filter(|&k| times[k] - times[k - 1] > gap_s));
        edges.push(times.len());
        let parts = edges.len() - 1;
        let longest =
            edges.windows(2).max_by_key(|pair| pair[1] - pair[0]).map_or((0, 0), |pair| (pair[0], pair[1]));
        let samples = longest.1 - longest.0;
        if samples < FEWEST {
            let gaps =
                if parts > 1 { format!(" without a gap (there are {})", parts - 1) } else { String::new() };
            return Err(Error::recording(InputError::new(
                Refusal::NoiseUndetermined,
                format!("{samples} samples{gaps} from {start_s} to {end_s} s do not determine the noise"),
                format!("it takes {FEWEST} samples at least, and minutes at rest to be of use"),
            )));
        }
        let times = &times[longest.0..longest.1];
        let interval_s = (times[samples - 1] - times[0]) / (samples - 1) as f64;
        let jitter =
            times.windows(2).fold(0.0_f64, |most, t| most.max((t[1] - t[0] - interval_s).abs())) / interval_s;
        Ok(Self {
            first: first + longest.0,
            end: first + longest.1,
            start_s: times[0],
            end_s: times[samples - 1],
            interval_s,
            jitter,
            missing: lacks(times),
            parts,
        })
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.end - self.first
    }

    /// Duration, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.start_s
    }

    /// Sample rate, Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.interval_s.recip()
    }
}

fn check(recording: &Recording, start_s: f64, end_s: f64) -> Result<()> {
    let reject = |message: String, help: String| {
        Err(Error::experiment(InputError::new(Refusal::HoldsInvalid, message, help)))
    };
    let stated = |t: f64| if t.abs() < 1e12 { t.to_string() } else { format!("{t:e}") };
    let rounded = |t: f64| stated((1e3 * t).round() / 1e3);
    let interval = format!("from {} to {} s", stated(start_s), stated(end_s));
    if !(start_s.is_finite() && end_s.is_finite()) {
        let message = format!("an interval {interval} is none");
        return reject(message, "give its start and its end in seconds".into());
    }
    if end_s <= start_s {
        let message = format!("the interval {interval} ends before it starts");
        return reject(message, "give its start first, then its end, both in seconds".into());
    }
    match (recording.times_s.first(), recording.times_s.last()) {
        (Some(&first), Some(&last)) if start_s > last || end_s < first => reject(
            format!("the interval {interval} lies outside the recording"),
            format!("the recording goes from {} to {} s", rounded(first), rounded(last)),
        ),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;
    use nalgebra::Vector3;

    fn recording(times_s: Vec<f64>) -> Recording {
        let readings = vec![Vector3::zeros(); times_s.len()];
        Recording { times_s, readings, axes: 3, unit: ReadingUnit::MetrePerSecondSquared }
    }

    #[test]
    fn a_gap_ends_a_stretch() {
        let times = (0..1000).filter(|k| !(300..305).contains(k)).map(|k| f64::from(k) * 0.01).collect();
        let segment = Segment::between(&recording(times), 0.5, 9.0).expect("long enough");
        assert_eq!((segment.parts, segment.samples()), (2, 596));
        assert!((segment.start_s - 3.05).abs() < 1e-12 && (segment.interval_s - 0.01).abs() < 1e-12);
        assert!(segment.jitter < 1e-9 && segment.missing == 0.0);
    }

    #[test]
    fn single_samples_may_be_missing() {
        let lacking = |one_in: i32| {
            let times = (0..10_000).filter(|k| k * 7919 % one_in != 1).map(|k| f64::from(k) * 0.01).collect();
            Segment::between(&recording(times), 0.0, 99.0)
        };
        let segment = lacking(37).expect("one in 37");
        assert_eq!(segment.parts, 1);
        assert!((segment.missing * 37.0 - 1.0).abs() < 0.01, "{}", segment.missing);
        assert!((segment.interval_s / 0.01 * 36.0 / 37.0 - 1.0).abs() < 1e-3, "{}", segment.interval_s);
        assert!(lacking(7).expect_err("too many").to_string().contains("without a gap"));
    }

    #[test]
    fn an_interval_that_is_none_is_refused() {
        let recording = recording((0..1000).map(|k| f64::from(k) * 0.01).collect());
        let stated = |start, end| Segment::between(&recording, start, end).expect_err("refused").to_string();
        assert!(stated(f64::NAN, 5.0).contains("from NaN to 5 s is none"));
        assert!(stated(0.0, f64::INFINITY).contains("from 0 to inf s is none"));
        assert!(stated(5.0, 1.0).contains("from 5 to 1 s ends before it starts"));
        assert!(stated(20.0, 30.0).contains("from 20 to 30 s lies outside the recording"));
        assert!(stated(1e307, 1e308).contains("from 1e307 to 1e308 s lies outside"));
        assert!(stated(-3.0, -1.0).contains("the recording goes from 0 to 9.99 s"));
    }

    #[test]
    fn too_short_is_refused_with_the_reason() {
        let times = (0..300).filter(|k| k % 8 != 0).map(|k| f64::from(k) * 0.01).collect();
        let error = Segment::between(&recording(times), 0.0, 3.0).expect_err("gaps everywhere");
        assert!(error.to_string().contains("7 samples without a gap (there are 37)"), "{error}");
    }
}
