//! Quality of a recording as a whole: gaps, irregular sampling, axes that are not connected, clipped readings.

use super::finding::{Finding, FindingKind, short};
use super::rows::LineMap;
use crate::sensor::Recording;

/// A step of the time is a gap from this many median steps on.
const GAP: f64 = 5.0;
/// Most gaps that are told one by one.
const GAPS_SHOWN: usize = 3;
/// Relative deviation of time steps from their median that is not worth a word.
const JITTER: f64 = 0.01;
/// A plateau at the extreme value is noticed from this many samples on …
const PLATEAU: usize = 8;
/// … if it is this many times longer than any plateau at another value. (The readings of a sensor that lies still repeat
/// everywhere, or nowhere.)
const PLATEAU_RATIO: usize = 4;

/// Looks at a recording of at least two samples.
pub(super) fn examine(recording: &Recording, lines: &LineMap, findings: &mut Vec<Finding>) {
    sampling(recording, lines, findings);
    readings(recording, "", lines, findings);
}

/// Looks for axes that are not connected or clipped. `of` goes before the word axis, as in `gyroscope axis x`.
pub(super) fn readings(recording: &Recording, of: &str, lines: &LineMap, findings: &mut Vec<Finding>) {
    for &axis in recording.active_axes() {
        let values: Vec<f64> = recording.readings.iter().map(|reading| reading[axis.index()]).collect();
        let (least, most) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), &v| (l.min(v), m.max(v)));
        if least == most {
            let message =
                format!("{of}axis {axis} never changes: {} throughout; is it connected?", short(least));
            findings.push(Finding::new(FindingKind::ConstantAxis, None, message));
            continue;
        }
        let plateaus = Plateaus::of(&values, least, most);
        for (word, value, (length, first)) in
            [("smallest", least, plateaus.least), ("largest", most, plateaus.most)]
        {
            if length >= PLATEAU && length > PLATEAU_RATIO * plateaus.elsewhere {
                let message = format!(
                    "{of}axis {axis} may be saturated: {length} samples in a row at its {word} value {} {}",
                    short(value),
                    recording.unit.symbol()
                );
                findings.push(Finding::new(FindingKind::Saturation, lines.line(first), message));
            }
        }
    }
}

/// Looks for gaps and irregular sampling.
pub(super) fn sampling(recording: &Recording, lines: &LineMap, findings: &mut Vec<Finding>) {
    let rate = recording.rate_hz();
    let median = 1.0 / rate;
    let (mut gaps, mut longest, mut least, mut most) = (0_usize, (0.0, 0), f64::INFINITY, 0.0_f64);
    for (before, pair) in recording.times_s.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if step > GAP * median {
            gaps += 1;
            if step > longest.0 {
                longest = (step, before);
            }
            if gaps <= GAPS_SHOWN {
                let message = format!(
                    "gap of {} s after t = {} s, about {:.0} samples",
                    short(step),
                    short(pair[0]),
                    (step / median).round() - 1.0
                );
                findings.push(Finding::new(FindingKind::Gap, lines.line(before + 1), message));
            }
        } else {
            least = least.min(step);
            most = most.max(step);
        }
    }
    if gaps > GAPS_SHOWN {
        let (step, before) = longest;
        let message = format!(
            "and {} more gaps; the longest is {} s after t = {} s",
            gaps - GAPS_SHOWN,
            short(step),
            short(recording.times_s[before])
        );
        findings.push(Finding::new(FindingKind::Gap, lines.line(before + 1), message));
    }
    // rounding of large time stamps is no jitter
    let resolution =
        4.0 * f64::EPSILON * recording.times_s.iter().fold(0.0_f64, |largest, t| largest.max(t.abs()));
    if most - median > JITTER * median + resolution || median - least > JITTER * median + resolution {
        let message = format!(
            "sampling is irregular: time steps from {} to {} ms, median {} ms ({} Hz)",
            short(least * 1e3),
            short(most * 1e3),
            short(median * 1e3),
            short(rate)
        );
        findings.push(Finding::new(FindingKind::IrregularSampling, None, message));
    }
}

/// Longest runs of equal readings: at the least value, at the largest (length and first sample), and anywhere else.
struct Plateaus {
    least: (usize, usize),
    most: (usize, usize),
    elsewhere: usize,
}

impl Plateaus {
    fn of(values: &[f64], least: f64, most: f64) -> Self {
        let mut plateaus = Self { least: (0, 0), most: (0, 0), elsewhere: 0 };
        let mut first = 0;
        for run in values.chunk_by(|one, next| one == next) {
            let found = (run.len(), first);
            if run[0] == least {
                plateaus.least = if found.0 > plateaus.least.0 { found } else { plateaus.least };
            } else if run[0] == most {
                plateaus.most = if found.0 > plateaus.most.0 { found } else { plateaus.most };
            } else {
                plateaus.elsewhere = plateaus.elsewhere.max(run.len());
            }
            first += run.len();
        }
        plateaus
    }
}
