//! Diagnostics in words: the one place where their sentences are made.

mod accelerometer;
mod change;
mod imu;
mod motion;
mod noise;
mod spikes;
mod time;

pub use accelerometer::coarse_axis;
pub(crate) use change::headline;
pub use spikes::spikes_taken_out;

use calibrant_core::diagnostic::Diagnostic;

/// A diagnostic in words, for the user: what was seen, and what to do.
///
/// # Examples
/// ```
/// use calibrant_core::diagnostic::Diagnostic;
/// use calibrant_core::sensor::Axis;
/// let found = Diagnostic::ScaleNegative { axis: Axis::Y };
/// assert_eq!(found.code().name(), "scale-negative");
/// assert_eq!(calibrant_report::message(&found), "the scale factor of axis y is negative: is the axis reversed?");
/// ```
#[must_use]
pub fn message(diagnostic: &Diagnostic) -> String {
    let areas = [accelerometer::message, motion::message, imu::message, noise::message];
    let words = areas.into_iter().find_map(|message| message(diagnostic));
    // a code that is newer than these words
    words.unwrap_or_else(|| diagnostic.code().entry().meaning.to_owned())
}
