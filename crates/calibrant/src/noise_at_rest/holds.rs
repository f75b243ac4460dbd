//! The part of a recording at rest: its longest hold, or a given interval that is checked for movement.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::noise::NoiseHoldMoves;
use calibrant_core::error::{Error, InputError, Refusal, Result, with_options_worded};
use calibrant_core::estimate::{find_holds, find_imu_holds};
use calibrant_core::motion::Hold;
use calibrant_core::noise::Segment;
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};

/// Shortest hold of the search, s.
const SHORTEST_HOLD_S: f64 = 1.0;
/// The hold detector may cut off this much of a hold at each end, s.
const TRIMMED_S: f64 = 0.5;
/// The table states the examined part if it is below this share of the recording.
const MOST: f64 = 0.9;

/// The holds. All recorded sensors are stationary in a hold. A gyroscope alone does not show a rotation at a steady
/// rate.
///
/// A spike is not a movement, and does not divide a hold.
pub(super) fn holds(imu: &ImuRecording) -> Result<Vec<Hold>> {
    let (clean, _) = imu.without_spikes();
    match (&clean[SensorKind::Accelerometer], &clean[SensorKind::Gyroscope]) {
        (None, Some(gyroscope)) => find_holds(gyroscope, SHORTEST_HOLD_S),
        _ => find_imu_holds(&clean, SHORTEST_HOLD_S),
    }
}

/// The longest hold.
pub(super) fn longest(holds: &[Hold]) -> Result<&Hold> {
    Hold::longest(holds).map(|number| &holds[number]).ok_or_else(|| {
        Error::Recording(Box::new(InputError::new(
            Refusal::HoldsMissing,
            format!("no hold of {SHORTEST_HOLD_S} s or more is found"),
            "noise needs a sensor at rest; if it was at rest, give the interval with option `hold` START END",
        )))
    })
}

/// The examined part of the recording, in words. `None` if it is nearly all of it.
pub(super) fn examined(holds: &[Hold], segment: &Segment, recording: &Recording) -> Option<String> {
    let (first, last) = recording.times_s().first().zip(recording.times_s().last())?;
    let (used_s, recorded_s) = (segment.duration_s(), last - first);
    (used_s < MOST * recorded_s).then(|| {
        let hold = match holds.len() {
            1 => "the only hold".to_owned(),
            n => format!("the longest of {n} holds"),
        };
        with_options_worded(format!(
            "{used_s:.1} of the {recorded_s:.1} s recorded, {hold}. Elsewhere the sensor moves, vibrates, or has no samples (option `hold` START END chooses another interval)"
        ))
    })
}

/// A warning if the sensor moves in the given interval. The interval then contains more than one hold, or is longer
/// than its hold.
pub(super) fn moves(holds: &[Hold], given: &Segment) -> Option<Diagnostic> {
    if holds.is_empty() {
        return None;
    }
    let within: Vec<&Hold> =
        holds.iter().filter(|hold| hold.end_s > given.start_s && hold.start_s < given.end_s).collect();
    let Some((first, last)) = within.first().zip(within.last()) else {
        return Some(moving(given.duration_s(), given));
    };
    let ends = [first.start_s - given.start_s, given.end_s - last.end_s];
    let between: f64 = within.windows(2).map(|pair| pair[1].start_s - pair[0].end_s).sum();
    let moving_s = between + ends.into_iter().filter(|end_s| *end_s > TRIMMED_S).sum::<f64>();
    (moving_s > 0.0).then(|| moving(moving_s, given))
}

fn moving(moving_s: f64, given: &Segment) -> Diagnostic {
    Diagnostic::from(NoiseHoldMoves { moving_s, given_s: given.duration_s() })
}
