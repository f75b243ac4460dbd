//! Holds in which the accelerometer saturates. Their means are wrong.
//!
//! Saturation moves the mean, always to the same side, and makes the scatter within the hold too small. These holds are unusable, whatever their
//! residuals.

use crate::diagnostic::HoldReason;
use crate::error::{Error, NotIdentifiable};
use crate::motion::Hold;
use crate::sensor::{Recording, Saturation};

/// The end of the range that each hold reaches. `None` for a hold without saturation.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{clipped_holds, holds_between};
/// use calibrant_core::sensor::{ReadingUnit, Recording};
/// use nalgebra::Vector3;
///
/// // two holds; in the second, x would show 9.8 m/s²
/// let reading = |k: usize| {
///     let noise = 1e-3 * (k * k % 17) as f64;
///     let force = if k < 50 { Vector3::new(0.0, 9.8, 0.0) } else { Vector3::new(9.8, 0.0, 0.0) };
///     let all = force + Vector3::repeat(noise);
///     Vector3::new(all.x.min(8.0), all.y, all.z)
/// };
/// let (times_s, readings) = ((0..100).map(f64::from).collect(), (0..100).map(reading).collect());
/// let recording = Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared)?;
/// let holds = holds_between(&recording, &[(0.0, 49.0), (50.0, 99.0)])?;
/// let clipped = clipped_holds(&recording, &holds);
/// assert!(clipped[0].is_none());
/// assert_eq!(clipped[1].map(|end| (end.axis.to_string(), end.value)), Some(("x".to_owned(), 8.0)));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn clipped_holds(recording: &Recording, holds: &[Hold]) -> Vec<Option<Saturation>> {
    let ends = recording.saturations();
    let touched = |hold: &Hold| {
        let readings = recording.readings.get(hold.first..hold.end)?;
        ends.iter().find(|end| end.is_reached(readings)).copied()
    };
    holds.iter().map(touched).collect()
}

/// Why a hold is not used.
pub(in crate::estimate) fn reason(end: &Saturation, recording: &Recording) -> HoldReason {
    HoldReason::Saturated { axis: end.axis, reading: end.value, unit: recording.unit }
}

/// Adds the number of saturated holds to an error about the other holds.
pub(in crate::estimate) fn with_clipped(
    error: Error,
    clipped: &[Option<Saturation>],
    recording: &Recording,
) -> Error {
    let ends: Vec<&Saturation> = clipped.iter().flatten().collect();
    let Some(first) = ends.first() else { return error };
    let numbers: Vec<String> =
        (1..).zip(clipped).filter(|(_, end)| end.is_some()).map(|(number, _)| number.to_string()).collect();
    let stated = format!(
        "{} of {} holds ({}) were left out since the accelerometer saturates in them, axis {} at {} {} for one",
        ends.len(),
        clipped.len(),
        numbers.join(", "),
        first.axis,
        first.value,
        recording.unit.symbol()
    );
    let help = "record with a larger range, or tilt that axis away from the vertical";
    match error {
        Error::NotIdentifiable(undetermined) => {
            let mut groups = undetermined.groups;
            for group in &mut groups {
                group.reason = format!("{}; {stated}", group.reason);
                group.remedy = format!("{help}; {}", group.remedy);
            }
            Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
        }
        Error::Recording(mut input_error) => {
            input_error.message = format!("{}; {stated}", input_error.message);
            input_error.help = format!("{help}; {}", input_error.help);
            Error::Recording(input_error)
        }
        other => other,
    }
}
