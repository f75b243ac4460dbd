//! Checks of a recording of a commanded motion.

use super::check::checks;
use super::parts::Phrase;

checks! {
    /// Samples lie outside the commanded motion. They are not used.
    SamplesOutsideMotion "samples-outside-motion" Warning {
        /// Number of samples outside.
        outside: usize,
        /// Number of samples.
        samples: usize,
        /// Begin of the motion, s.
        motion_start_s: f64,
        /// End of the motion, s.
        motion_end_s: f64,
    }
    decided "Their times are before its begin or after its end."
    remedy "Check that both clocks start together."
    says format!(
        "{outside} of {samples} samples lie outside the motion, {motion_start_s} to {motion_end_s} s. They are not used."
    );

    /// The motion has another number of intervals than the experiment states.
    IntervalsDiffer "intervals-differ" Note {
        /// The name of the motion.
        motion: Phrase,
        /// Intervals of the motion.
        intervals: usize,
        /// Intervals that the experiment states.
        stated: usize,
    }
    decided "motion.intervals is compared with the rows of the motion."
    remedy "Nothing: the motion counts. Correct motion.intervals."
    says format!("{} has {intervals} intervals, the experiment file {stated}: the former counts", motion.0);

    /// Parts of the commanded motion were not recorded.
    MotionNotRecorded "motion-not-recorded" Warning {
        /// Duration of the intervals without a sample, s.
        empty_s: f64,
        /// Duration of the motion, s.
        motion_s: f64,
    }
    decided "Intervals without a sample make up more than a tenth of the motion."
    remedy "Record the whole motion."
    says format!(
        "the recording has no samples in {:.0} % of the motion's {motion_s} s. Record the whole motion.",
        100.0 * empty_s / motion_s
    );
}
