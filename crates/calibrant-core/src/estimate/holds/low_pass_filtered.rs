//! Holds that a low-pass filter breaks up.
//!
//! Behind a filter far below the sample rate, neighbouring samples have nearly the same noise. The variance of a short window then follows the
//! slow noise. Half of a hold may look calmer than the rest, and the hold breaks up into pieces that are too short. The structure function of the
//! samples, `D(k) = E (y_{i+k} − y_i)²`, shows the filter. White noise has `D(4)/D(1) = 1`. A pole ρ has `1 + ρ + ρ² + ρ³`, which is 3 at ρ = 0.81.
//! A steady movement has 16.

use super::hold_detection::still_segments;
use crate::diagnostic::holds::HoldsLostToFilter;
use crate::error::{Error, NotIdentifiable};
use crate::motion::Hold;
use crate::sensor::Recording;
use std::ops::Range;

/// Least `D(4)/D(1)` of filtered samples.
const FILTERED: f64 = 3.0;
/// Least `D(4)/D(1)` of a movement, in a recording without holds.
const MOVING: f64 = 6.0;
/// Largest number of samples for the ratio.
const MOST_SAMPLES: usize = 4096;
/// Number of stationary segments between the holds that are normal, since a sensor may pause in a rotation.
const PAUSES: usize = 2;

/// Segments that look stationary but are too short for holds, because neighbouring samples are correlated. `None` if they are not correlated.
///
/// The `holds` are those that [`find_holds`](super::find_holds) or [`find_imu_holds`](crate::estimate::find_imu_holds) found in the recording.
#[must_use]
pub fn holds_lost_to_filter(
    recording: &Recording,
    holds: &[Hold],
    minimum_s: f64,
) -> Option<HoldsLostToFilter> {
    let pieces = pieces(recording, holds, minimum_s)?;
    (pieces > PAUSES).then_some(HoldsLostToFilter { holds: holds.len(), stretches: pieces, minimum_s })
}

/// Adds the filter as a reason to an error about too few holds, where there is a filter.
pub(in crate::estimate) fn with_filter(
    error: Error,
    recording: &Recording,
    holds: &[Hold],
    minimum_s: f64,
) -> Error {
    let Error::NotIdentifiable(undetermined) = error else { return error };
    if pieces(recording, holds, minimum_s).is_none_or(|pieces| pieces == 0) {
        return Error::NotIdentifiable(undetermined);
    }
    let mut groups = undetermined.groups;
    for group in &mut groups {
        group.reason = format!("{}; {}", group.reason, HoldsLostToFilter::REASON);
        group.remedy = format!("{}; {}", HoldsLostToFilter::HELP, group.remedy);
    }
    Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
}

/// Number of stationary segments that are not holds. `None` if the samples are not filtered.
fn pieces(recording: &Recording, holds: &[Hold], minimum_s: f64) -> Option<usize> {
    let of_holds = holds.iter().map(|hold| hold.first..hold.end);
    if !holds.is_empty() && smoothness(recording, of_holds)? < FILTERED {
        return None;
    }
    let (segments, _) = still_segments(recording, minimum_s, recording.rate_hz());
    if holds.is_empty()
        && !(FILTERED..MOVING).contains(&smoothness(recording, segments.iter().map(|&(from, to)| from..to))?)
    {
        return None;
    }
    let is_in = |from: usize, to: usize| holds.iter().any(|hold| hold.first < to && from < hold.end);
    Some(segments.iter().filter(|(from, to)| !is_in(*from, *to)).count())
}

/// `D(4)/D(1)` of the samples in these ranges, or of the first of them; `None` where there is no noise.
fn smoothness(recording: &Recording, ranges: impl Iterator<Item = Range<usize>>) -> Option<f64> {
    let (mut near, mut far, mut count) = (0.0, 0.0, 0);
    for range in ranges {
        let readings = recording.readings.get(range)?;
        for about in readings.windows(5) {
            near += (about[1] - about[0]).norm_squared();
            far += (about[4] - about[0]).norm_squared();
        }
        count += readings.len();
        if count > MOST_SAMPLES {
            break;
        }
    }
    (near > 0.0).then(|| far / near)
}
