//! Checks of the noise of a sensor at rest.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{counted, plain, short_time};
use crate::sensor::{Axis, ReadingUnit, SensorKind};

checks! {
    /// The noise of a sensor is not found; that of the other is.
    NoiseImpossible "noise-impossible" Warning {
        sensor_kind: SensorKind,
        why: Phrase,
    }
    decided "The search ends with an error."
    remedy "Read the error."
    says format!("no noise of the {sensor_kind}: {}", why.0);

    /// Spikes make most of the noise of an axis. It is not that of a sensor at rest.
    NoiseOfSpikes "noise-of-spikes" Note {
        sensor_kind: SensorKind,
        axis: Axis,
        /// Are there too many of them, not only a few?
        are_many: bool,
    }
    decided "More than one sample in fifty is an outlier, or the fourth moment is that of a few samples."
    remedy "Look for a loose contact, a lost bit, or knocks."
    says match are_many {
        true => format!("there are too many spikes on axis {axis} of the {sensor_kind}"),
        false => format!("a few spikes make most of the noise of axis {axis} of the {sensor_kind}"),
    };

    /// A vibration makes most of the noise of an axis. It is not that of a sensor at rest.
    NoiseOfVibration "noise-of-vibration" Note {
        sensor_kind: SensorKind,
        axis: Axis,
        /// Frequency of its line, Hz; `None` where no line is seen, and no process explains the Allan deviation.
        frequency_hz: Option<f64>,
    }
    decided "A line in the spectrum cannot be subtracted, or the misfit of all processes has a probability below 1e-9."
    remedy "Record where nothing vibrates."
    says match frequency_hz {
        Some(hertz) => format!(
            "axis {axis} of the {sensor_kind} has a line at {} Hz: a vibration, or the hum of the mains?",
            plain(*hertz, 3)
        ),
        None => format!(
            "no sum of the processes explains the Allan deviation of axis {axis} of the {sensor_kind}: a vibration?"
        ),
    };

    /// Outliers were removed before the noise was estimated. Or they are too many to remove, and the noise
    /// includes them.
    NoiseOutliers "noise-outliers" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        unit: ReadingUnit,
        /// Their number.
        outliers: usize,
        /// Number of samples.
        samples: usize,
        /// Reading of the sample that is farthest from its neighbours.
        reading: f64,
        /// Its time, s.
        time_s: f64,
        /// Its distance from its neighbours, in usual differences of two samples.
        deviations: f64,
        /// Were they removed? They are not where they are too many.
        left_out: bool,
        /// White noise with the outliers over white noise without them.
        white_noise_ratio: Option<f64>,
    }
    decided "They are more than 8 robust standard deviations from the median of nine neighbouring samples. Up to \
        one sample in fifty is removed."
    remedy "Look for a loose contact, a lost bit, or a knock."
    says {
        let farthest = format!(
            "the farthest is {} {} at {time_s:.3} s, {deviations:.0} times the usual difference of two samples from its \
             neighbours",
            plain(*reading, 3),
            unit.symbol()
        );
        let of = format!("{sensor_kind} {axis}: {outliers} of {samples} samples");
        let (are, removed, them) = match outliers {
            1 => ("is an outlier", "It is removed", "it"),
            _ => ("are outliers", "They are removed", "them"),
        };
        let with_them = match white_noise_ratio {
            Some(ratio) => format!("With {them}, N would be {ratio:.2} times as large."),
            None => "The stated noise is that of the other samples.".to_owned(),
        };
        match left_out {
            true => format!(
                "{of} {are} ({farthest}). {removed}: a spike, a lost bit or a knock does not average out as noise does. \
                 {with_them}"
            ),
            false => format!(
                "{of} are spikes ({farthest}). These are more than one sample in fifty, or several in a row, and too many \
                 to remove. The noise includes them. Look for a loose contact, or for bits lost on the way."
            ),
        }
    };

    /// Samples are missing. The others are treated as consecutive samples.
    SamplesMissing "samples-missing" Warning {
        /// Share of the samples.
        missing_share: f64,
    }
    decided "The sample times have gaps of one or a few intervals."
    remedy "Find the part of the data path that loses samples."
    says format!(
        "{:.1} % of the samples are missing. The others are treated as consecutive samples. N is therefore {:.1} % above \
         the sensor's own.",
        100.0 * missing_share,
        100.0 * ((1.0 - missing_share).sqrt().recip() - 1.0)
    );

    /// The sample times vary. Short cluster times are less certain than stated.
    SampleTimesVary "sample-times-vary" Warning {
        /// Largest variation, as a share of the interval.
        jitter: f64,
    }
    decided "They vary by more than a fifth of the interval."
    remedy "Take the times from the sensor's clock."
    says format!(
        "the time between samples differs from its mean by up to {:.0} %. The Allan deviation at short cluster times is \
         less certain than stated. Take the times from the sensor's clock.",
        100.0 * jitter
    );

    /// Gaps were filled, so that all of the recording counts.
    NoiseGapsFilled "noise-gaps-filled" Note {
        /// Number of gaps.
        gaps: usize,
        /// Share of the samples.
        share: f64,
    }
    decided "A gap is five usual sample intervals or longer, and not more than a tenth of the samples is missing."
    remedy "Find the part of the data path that loses samples."
    says format!(
        "{}, {:.1} % of the samples, {} filled with noise like that before {}, so that all of the recording counts.",
        counted(*gaps, "gap"),
        100.0 * share,
        if *gaps == 1 { "is" } else { "are" },
        if *gaps == 1 { "it" } else { "them" }
    );

    /// Gaps cut the hold into parts. The longest was examined.
    NoiseInParts "noise-in-parts" Warning {
        /// Number of parts.
        parts: usize,
        /// Duration of the longest part, s.
        longest_s: f64,
    }
    decided "Gaps are filled where not more than a tenth of the samples is missing; here it is more."
    remedy "Record without gaps."
    says format!(
        "gaps cut the hold into {parts} parts. The longest part, {}, was examined.",
        short_time(*longest_s)
    );

    /// The sensor moves in the interval that option `hold` gives.
    NoiseHoldMoves "noise-hold-moves" Warning {
        /// For how long it moves, s.
        moving_s: f64,
        /// Duration of the interval, s.
        given_s: f64,
    }
    decided "The holds found in it do not cover all of it."
    remedy "Omit option `hold`, or choose an interval at rest."
    says format!(
        "the sensor moves or vibrates in {moving_s:.1} of the {given_s:.1} s given with option `hold`. The result is not the \
         noise of a sensor at rest. `calibrant inspect` counts the holds. Without option `hold`, the longest is used."
    );

    /// An axis drifts. The drift is subtracted.
    NoiseDrifts "noise-drifts" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        unit: ReadingUnit,
        /// Drift in one second.
        drift_per_s: f64,
        /// The drift, in standard deviations of the drift that its noise explains.
        deviations: f64,
    }
    decided "The drift is larger than the noise explains."
    remedy "Let the sensor warm up."
    says format!(
        "{sensor_kind} {axis} drifts by {} {} per hour, {deviations:.1} standard deviations of the drift that its noise \
         explains. Is it warming up? The drift is subtracted, since it is not a random walk.",
        plain(3600.0 * drift_per_s, 3),
        unit.symbol()
    );

    /// No combination of the noise processes explains the Allan deviation.
    NoiseUnexplained "noise-unexplained" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        chi2: f64,
        /// Degrees of freedom.
        degrees_of_freedom: usize,
    }
    decided "The χ² of the fit is too large."
    remedy "Look for vibration. Do not trust the intervals."
    says format!(
        "{sensor_kind} {axis}: no combination of the noise processes explains the Allan deviation (χ² {} with \
         {degrees_of_freedom} degrees of freedom). Did the sensor vibrate, or was it touched? Do not trust the intervals.",
        plain(*chi2, 3)
    );

    /// Neighbouring samples are correlated, as behind a filter in the sensor. The stated noise is that
    /// before the filter.
    NoiseFiltered "noise-filtered" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        /// Samples closer in time than this are correlated, s.
        correlated_s: f64,
    }
    decided "The noise at short cluster times is below that of white noise."
    remedy "Nothing, if you use means of many samples."
    says format!(
        "{sensor_kind} {axis}: samples less than {} apart are correlated, as behind a filter in the sensor. The stated \
         noise is that before the filter. It holds for means of many samples.",
        short_time(*correlated_s)
    );

    /// No combination of the noise processes explains short cluster times. They are not fitted.
    ShortTimesUnexplained "short-times-unexplained" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        /// Shortest cluster time of the fit, s.
        shortest_tau_s: f64,
    }
    decided "The fit is good without them, and not with them."
    remedy "Look for vibration or a filter."
    says format!(
        "{sensor_kind} {axis}: no combination of the noise processes explains cluster times below {}. They are not fitted.",
        short_time(*shortest_tau_s)
    );

    /// The spectrum has a line. The stated noise excludes it.
    NoiseVibration "noise-vibration" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        /// Its frequency, Hz.
        frequency_hz: f64,
        /// Its share of the variance of the samples.
        share: f64,
        /// Its share of N².
        of_white: f64,
    }
    decided "A peak is significant, and has at least a hundredth of the variance of the samples."
    remedy "Look for vibration, or for mains hum."
    says format!(
        "{sensor_kind} {axis}: a line at {} Hz has {} % of the samples' variance. Is it a vibration, or mains hum? The \
         stated noise excludes it. With it, N would be {:.1} % larger.",
        plain(*frequency_hz, 3),
        plain(100.0 * share, 2),
        50.0 * of_white.max(0.0)
    );

    /// Part of the noise does not average out like independent samples.
    NoiseBeyondWhite "noise-beyond-white" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        unit: ReadingUnit,
        /// Standard deviation of the samples.
        sample_sd: f64,
        /// The white noise.
        white_noise: f64,
    }
    decided "The standard deviation of the samples exceeds the white noise by 15 %."
    remedy "Take the noise from the Allan deviation, not from the samples."
    says format!(
        "{sensor_kind} {axis}: the samples' standard deviation, {} {unit}, exceeds the white noise, {} {unit}. Part of the \
         noise does not average out like independent samples.",
        plain(*sample_sd, 3),
        plain(*white_noise, 3),
        unit = unit.symbol()
    );

    /// The resolution is coarser than the noise. The stated noise is partly rounding.
    ResolutionCoarse "resolution-coarse" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        unit: ReadingUnit,
        /// The smallest step.
        step: f64,
    }
    decided "The smallest step exceeds the standard deviation of the samples."
    remedy "Choose a smaller range, or write more digits to the file."
    says format!(
        "{sensor_kind} {axis}: the resolution, {} {}, is coarser than the noise. The stated noise is partly rounding.",
        plain(*step, 3),
        unit.symbol()
    );
}
