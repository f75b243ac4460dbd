//! The stretch of a recording whose noise is examined: at rest, at equal intervals.

use crate::error::{Complaint, Error, Result};
use crate::sensor::Recording;
use std::ops::Range;

/// A time step is a gap from this many median steps on.
const GAP: f64 = 1.5;
/// Fewest samples.
const FEWEST: usize = 96;

/// Samples without a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
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
    /// Parts that gaps make of the interval that was asked for; this is the longest.
    pub parts: usize,
}

impl Stretch {
    /// The longest stretch without a gap between these times in s.
    ///
    /// Missing samples would shift all that follow against the clusters, so a gap ends a stretch. Jitter of the sample times averages out and is only
    /// reported.
    ///
    /// # Errors
    /// [`Error::Recording`] where it has fewer than 96 samples.
    pub fn between(recording: &Recording, start_s: f64, end_s: f64) -> Result<Self> {
        let Range { start: first, end } = recording.between(start_s, end_s);
        let times = &recording.times_s[first..end];
        let step = recording.rate_hz().recip();
        let mut edges = vec![0];
        edges.extend((1..times.len()).filter(|&k| times[k] - times[k - 1] > GAP * step));
        edges.push(times.len());
        let parts = edges.len() - 1;
        let longest =
            edges.windows(2).max_by_key(|pair| pair[1] - pair[0]).map_or((0, 0), |pair| (pair[0], pair[1]));
        let samples = longest.1 - longest.0;
        if samples < FEWEST {
            let gaps =
                if parts > 1 { format!(" without a gap (there are {})", parts - 1) } else { String::new() };
            return Err(Error::recording(Complaint::new(
                format!(
                    "{samples} samples at rest{gaps} from {start_s} to {end_s} s do not determine the noise"
                ),
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
        let times = (0..1000).filter(|k| !(300..303).contains(k)).map(|k| f64::from(k) * 0.01).collect();
        let stretch = Stretch::between(&recording(times), 0.5, 9.0).expect("long enough");
        assert_eq!((stretch.parts, stretch.samples()), (2, 598));
        assert!((stretch.start_s - 3.03).abs() < 1e-12 && (stretch.interval_s - 0.01).abs() < 1e-12);
        assert!(stretch.jitter < 1e-9);
    }

    #[test]
    fn too_short_is_refused_with_the_reason() {
        let times = (0..300).filter(|k| k % 60 != 0).map(|k| f64::from(k) * 0.01).collect();
        let error = Stretch::between(&recording(times), 0.0, 3.0).expect_err("gaps everywhere");
        assert!(error.to_string().contains("59 samples at rest without a gap (there are 4)"), "{error}");
    }
}
