//! What of a recording is at rest, and no hold: for people who look for the hold that they made.

use super::hold_detection::still_segments;
use crate::motion::Hold;
use crate::sensor::Recording;

/// A rest shorter than this share of the shortest hold was not meant as one.
const SHORTEST: f64 = 0.5;

/// An interval at rest that is no hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefusedRest {
    /// Its start, s.
    pub start_s: f64,
    /// Its end, s.
    pub end_s: f64,
    /// Is it shorter than the shortest hold? Else the mean wanders in it, or the gyroscope turns.
    pub is_short: bool,
}

/// The intervals of an accelerometer at rest that none of these holds, at least `minimum_s` long, is in.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{find_holds, refused_rests};
/// use calibrant_core::sensor::{ReadingUnit, Recording};
/// use nalgebra::Vector3;
///
/// // at rest for 3 s, in motion for 1 s, at rest for 0.8 s, in motion
/// let at = |k: usize| match k {
///     0..300 | 400..480 => 0.01 * (k as f64 * 1.3).sin(),
///     _ => 3.0 * (k as f64 * 0.11).sin(),
/// };
/// let readings = (0..800).map(|k| Vector3::new(at(k), at(k + 7), 9.8)).collect();
/// let times_s = (0..800).map(|k| k as f64 / 100.0).collect();
/// let recording = Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared)?;
/// let holds = find_holds(&recording, 1.0)?;
/// let refused = refused_rests(&recording, &holds, 1.0);
/// assert_eq!((holds.len(), refused.len()), (1, 1));
/// assert!(refused[0].is_short && (refused[0].start_s - 4.0).abs() < 0.1);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn refused_rests(accelerometer: &Recording, holds: &[Hold], minimum_s: f64) -> Vec<RefusedRest> {
    let rate_hz = accelerometer.rate_hz();
    let (segments, _) = still_segments(accelerometer, minimum_s, rate_hz);
    let times_s = accelerometer.times_s();
    let rest = |(from, to): (usize, usize)| {
        let (start_s, end_s) = (times_s[from], times_s[to - 1]);
        let is_short = ((to - from) as f64) < minimum_s * rate_hz;
        let has_hold = holds.iter().any(|hold| hold.start_s < end_s && start_s < hold.end_s);
        let is_one = !has_hold && end_s - start_s >= SHORTEST * minimum_s;
        is_one.then_some(RefusedRest { start_s, end_s, is_short })
    };
    segments.into_iter().filter_map(rest).collect()
}
