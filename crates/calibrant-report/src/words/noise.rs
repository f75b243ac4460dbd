//! What is said of the noise of a sensor at rest.

use super::time::{short_time, three_digits, two_digits};
use calibrant_core::diagnostic::Diagnostic;

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
                    "{sensor_kind} {axis}: {outliers} of {samples} samples are sparks ({farthest}): single samples far off, too many to be left out, which one in fifty would be; what is stated is their \
                     noise, not that of the others. Look for their cause: a loose contact, bits lost on the way?"
                ));
            }
            let is_one = *outliers == 1;
            let with_them = match white_noise_ratio {
                Some(ratio) => format!(
                    "with {} N would be {ratio:.2} times as large",
                    if is_one { "it" } else { "them" }
                ),
                None => "the noise is that of the others".to_owned(),
            };
            format!(
                "{sensor_kind} {axis}: {outliers} of {samples} samples {} ({farthest}): a spark, a lost bit or a knock is no noise that averages out, and was left out; {with_them}",
                if is_one { "is an outlier" } else { "are outliers" }
            )
        }
        Diagnostic::SamplesMissing { missing_share } => format!(
            "{:.1} % of the samples are missing; the others are taken as if they followed one another: N is that of what was recorded, {:.1} % above the sensor's",
            100.0 * missing_share,
            100.0 * ((1.0 - missing_share).sqrt().recip() - 1.0)
        ),
        Diagnostic::SampleTimesVary { jitter } => format!(
            "the sample times vary by up to {:.0} % of the interval: short cluster times are less certain than stated",
            100.0 * jitter
        ),
        Diagnostic::NoiseInParts { parts, longest_s } => format!(
            "gaps cut the hold into {parts} parts; the longest, {}, was examined",
            short_time(*longest_s)
        ),
        Diagnostic::NoiseHoldMoves { moving_s, given_s } => format!(
            "the sensor moves in {moving_s:.1} of the {given_s:.1} s given with --hold, or is shaken: what follows is no noise of a sensor at rest (`calibrant inspect` shows how many \
             holds there are; without --hold the longest is taken)"
        ),
        _ => return of_processes(diagnostic),
    })
}

fn of_processes(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NoiseDrifts { sensor_kind, axis, unit, drift_per_s, deviations } => format!(
            "{sensor_kind} {axis} drifts by {} {} per hour ({deviations:.1} standard deviations of the most that its noise explains): warming up? The drift was \
             subtracted; it is no random walk",
            three_digits(3600.0 * drift_per_s),
            unit.symbol()
        ),
        Diagnostic::NoiseUnexplained { sensor_kind, axis, chi2, degrees_of_freedom } => format!(
            "{sensor_kind} {axis}: no sum of the processes explains the Allan deviation (χ² {} with {degrees_of_freedom} degrees of freedom): vibration, or a sensor that was \
             touched? Do not trust the intervals",
            three_digits(*chi2)
        ),
        Diagnostic::NoiseFiltered { sensor_kind, axis, correlated_s } => format!(
            "{sensor_kind} {axis}: samples less than {} apart are correlated (filtered in the sensor?); what is stated is the noise before the filter, which means of many \
             samples have",
            short_time(*correlated_s)
        ),
        Diagnostic::ShortTimesUnexplained { sensor_kind, axis, shortest_tau_s } => format!(
            "{sensor_kind} {axis}: no sum of the processes explains cluster times below {}: they were not fitted",
            short_time(*shortest_tau_s)
        ),
        Diagnostic::NoiseVibration { sensor_kind, axis, frequency_hz, share, of_white } => format!(
            "{sensor_kind} {axis}: a line at {} Hz has {} % of the samples' variance: a vibration, or the hum of the mains? What is stated is the noise beside it; with it N would be \
             {:.1} % larger",
            three_digits(*frequency_hz),
            two_digits(100.0 * share),
            50.0 * of_white.max(0.0)
        ),
        Diagnostic::NoiseBeyondWhite { sensor_kind, axis, unit, sample_sd, white_noise } => {
            let unit = unit.symbol();
            format!(
                "{sensor_kind} {axis}: the samples' standard deviation, {} {unit}, exceeds the white noise, {} {unit}: part of it does not average out like \
                 independent samples",
                three_digits(*sample_sd),
                three_digits(*white_noise)
            )
        }
        Diagnostic::ResolutionCoarse { sensor_kind, axis, unit, step } => format!(
            "{sensor_kind} {axis}: its resolution, {} {}, is coarser than its noise: what is stated is rounding as much as noise",
            three_digits(*step),
            unit.symbol()
        ),
        _ => return None,
    })
}

fn farthest(reading: f64, unit: &str, time_s: f64, deviations: f64) -> String {
    format!(
        "the farthest {} {unit} at {time_s:.3} s, {deviations:.0} times the usual difference of two samples off those beside it",
        three_digits(reading)
    )
}
