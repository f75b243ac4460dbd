//! Diagnostics in words. Their sentences are made here and nowhere else.

mod accelerometer;
mod change;
mod imu;
mod machine;
mod motion;
mod noise;
mod spikes;
mod verdict;

pub use accelerometer::coarse_axis;
pub(crate) use change::headline;
pub use spikes::spikes_taken_out;

use calibrant_core::diagnostic::Diagnostic;

/// The text with a capital letter first.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A diagnostic in words, for the user: what was found, and what to do.
///
/// It starts with a small letter, since `warning:` or the name of a file stands before it.
///
/// # Examples
/// ```
/// use calibrant_core::diagnostic::Diagnostic;
/// use calibrant_core::sensor::Axis;
/// let diagnostic = Diagnostic::ScaleNegative { axis: Axis::Y };
/// assert_eq!(diagnostic.code().name(), "scale-negative");
/// assert_eq!(calibrant_report::message(&diagnostic), "the scale factor of axis y is negative. Is the axis reversed?");
/// ```
#[must_use]
pub fn message(diagnostic: &Diagnostic) -> String {
    let areas = [
        accelerometer::message,
        motion::message,
        imu::message,
        noise::message,
        machine::message,
        verdict::message,
    ];
    let words = areas.into_iter().find_map(|message| message(diagnostic));
    // a code without words here
    words.unwrap_or_else(|| diagnostic.code().entry().meaning.to_owned())
}
