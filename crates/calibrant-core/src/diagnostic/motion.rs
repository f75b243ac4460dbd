//! Checks of a recording of a commanded motion.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::with_sd;

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

    /// The recording follows the motion at another time. The gains are wrong.
    MotionDelayed "motion-delayed" Warning {
        /// Delay that fits better: motion time less recording time, s.
        delay_s: f64,
        /// Its standard deviation, s.
        sd_s: f64,
    }
    decided "The clocks are given as exact, and a delay beside the parameters is beyond 5 of its standard deviations."
    remedy "Set delay_sd_s in [motion.clock]: the delay is then found, and its uncertainty is in the result."
    says format!(
        "the recording does not begin with the motion: a delay of {} ms fits better. Set delay_sd_s in [motion.clock], \
         such as 1.0: the delay is then found.",
        with_sd(1e3 * delay_s, 1e3 * sd_s)
    );

    /// The recording follows the commanded motion up to a time, and another one from then on.
    MotionChanges "motion-changes" Warning {
        /// The time of the motion at which it changes, s.
        change_s: f64,
        /// What it does from then on, where that was found.
        what: Option<Phrase>,
    }
    decided "Noise explains the samples before that time, and right behind it the residuals are more than three times the \
        noise. What the motion does then is named where it leaves half of the residuals or less."
    remedy "Look at what the machine did then, and record again. Or take the samples behind that time out of the recording."
    says format!(
        "the recording follows the motion up to {change_s:.1} s, and not from then on{}. Look at what the machine did \
         then, and record again. Or take the samples behind that time out of the recording.",
        what.as_ref().map_or_else(String::new, |what| format!(": {}", what.0))
    );

    /// The motion was found far from where it was expected.
    DelayUnexpected "delay-unexpected" Warning {
        /// Delay that was found: motion time less recording time, s.
        delay_s: f64,
        /// Delay that was expected, s.
        expected_s: f64,
        /// Standard deviation of the expected delay, s.
        sd_s: f64,
    }
    decided "The delay is more than 5 of its standard deviations from the expected one."
    remedy "Check that recording and motion belong together. If so, give the delay as delay_s in [motion.clock]."
    says format!(
        "the motion was found {delay_s:.3} s from the recording's times, not within {expected_s:.3} ± {sd_s:.3} s. \
         Check that both belong together."
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
