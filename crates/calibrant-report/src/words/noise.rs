//! Sentences about the noise of a sensor at rest.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::number_format::{plain, short_time};

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NoiseOutliers {
            sensor_kind,
            axis,
            unit,
            outliers,
            samples,
            reading,
            time_s,
            deviations,
            left_out,
            white_noise_ratio,
        } => {
            let farthest = farthest(*reading, unit.symbol(), *time_s, *deviations);
            if !left_out {
                return Some(format!(
                    "{sensor_kind} {axis}: {outliers} of {samples} samples are spikes ({farthest}). These are more than one sample in fifty, or several in a row, and too many to remove. The noise includes them. \
                     Look for a loose contact, or for bits lost on the way."
                ));
            }
            let is_one = *outliers == 1;
            let with_them = match white_noise_ratio {
                Some(ratio) => format!(
                    "With {}, N would be {ratio:.2} times as large.",
                    if is_one { "it" } else { "them" }
                ),
                None => "The stated noise is that of the other samples.".to_owned(),
            };
            let (are, removed) = if is_one {
                ("is an outlier", "It is removed")
            } else {
                ("are outliers", "They are removed")
            };
            format!(
                "{sensor_kind} {axis}: {outliers} of {samples} samples {are} ({farthest}). {removed}: a spike, a lost bit or a knock does not average out as noise does. {with_them}"
            )
        }
        Diagnostic::SamplesMissing { missing_share } => format!(
            "{:.1} % of the samples are missing. The others are treated as consecutive samples. N is therefore {:.1} % above the sensor's own.",
            100.0 * missing_share,
            100.0 * ((1.0 - missing_share).sqrt().recip() - 1.0)
        ),
        Diagnostic::SampleTimesVary { jitter } => format!(
            "the time between samples differs from its mean by up to {:.0} %. The Allan deviation at short cluster times is less certain than stated. Take the times from the sensor's clock.",
            100.0 * jitter
        ),
        Diagnostic::NoiseInParts { parts, longest_s } => format!(
            "gaps cut the hold into {parts} parts. The longest part, {}, was examined.",
            short_time(*longest_s)
        ),
        Diagnostic::NoiseHoldMoves { moving_s, given_s } => format!(
            "the sensor moves or vibrates in {moving_s:.1} of the {given_s:.1} s given with --hold. The result is not the noise of a sensor at rest. `calibrant inspect` counts the \
             holds. Without --hold, the longest is used."
        ),
        _ => return of_processes(diagnostic),
    })
}

fn of_processes(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NoiseDrifts { sensor_kind, axis, unit, drift_per_s, deviations } => format!(
            "{sensor_kind} {axis} drifts by {} {} per hour, {deviations:.1} standard deviations of the drift that its noise explains. Is it warming up? The drift is \
             subtracted, since it is not a random walk.",
            plain(3600.0 * drift_per_s, 3),
            unit.symbol()
        ),
        Diagnostic::NoiseUnexplained { sensor_kind, axis, chi2, degrees_of_freedom } => format!(
            "{sensor_kind} {axis}: no combination of the noise processes explains the Allan deviation (χ² {} with {degrees_of_freedom} degrees of freedom). Did the sensor vibrate, or was it \
             touched? Do not trust the intervals.",
            plain(*chi2, 3)
        ),
        Diagnostic::NoiseFiltered { sensor_kind, axis, correlated_s } => format!(
            "{sensor_kind} {axis}: samples less than {} apart are correlated, as behind a filter in the sensor. The stated noise is that before the filter. It holds for means of many \
             samples.",
            short_time(*correlated_s)
        ),
        Diagnostic::ShortTimesUnexplained { sensor_kind, axis, shortest_tau_s } => format!(
            "{sensor_kind} {axis}: no combination of the noise processes explains cluster times below {}. They are not fitted.",
            short_time(*shortest_tau_s)
        ),
        Diagnostic::NoiseVibration { sensor_kind, axis, frequency_hz, share, of_white } => format!(
            "{sensor_kind} {axis}: a line at {} Hz has {} % of the samples' variance. Is it a vibration, or mains hum? The stated noise excludes it. With it, N would be \
             {:.1} % larger.",
            plain(*frequency_hz, 3),
            plain(100.0 * share, 2),
            50.0 * of_white.max(0.0)
        ),
        Diagnostic::NoiseBeyondWhite { sensor_kind, axis, unit, sample_sd, white_noise } => {
            let unit = unit.symbol();
            format!(
                "{sensor_kind} {axis}: the samples' standard deviation, {} {unit}, exceeds the white noise, {} {unit}. Part of the noise does not average out like \
                 independent samples.",
                plain(*sample_sd, 3),
                plain(*white_noise, 3)
            )
        }
        Diagnostic::ResolutionCoarse { sensor_kind, axis, unit, step } => format!(
            "{sensor_kind} {axis}: the resolution, {} {}, is coarser than the noise. The stated noise is partly rounding.",
            plain(*step, 3),
            unit.symbol()
        ),
        _ => return None,
    })
}

fn farthest(reading: f64, unit: &str, time_s: f64, deviations: f64) -> String {
    format!(
        "the farthest is {} {unit} at {time_s:.3} s, {deviations:.0} times the usual difference of two samples from its neighbours",
        plain(reading, 3)
    )
}
