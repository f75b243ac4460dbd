//! The quality of a recording as a whole: gaps, irregular sampling, axes that are not connected, clipped
//! readings.

use super::reader_finding::{Finding, FindingKind, count, moment, short};
use super::row_reader::LineMap;
use calibrant_core::sensor::{Axis, Recording, greater, lesser, missing};
use nalgebra::Vector3;

/// A time step is a gap from this many usual steps on.
const GAP: f64 = 5.0;
/// Largest number of gaps that are listed one by one.
const GAPS_SHOWN: usize = 3;
/// Largest relative deviation of time steps from the usual one that needs no finding.
const JITTER: f64 = 0.01;
/// Inertial sensors are seldom read more slowly than this. Below it, the unit of the time is doubtful.
const SLOW_HZ: f64 = 2.5;
/// Rates from here on are usual.
const USUAL_HZ: f64 = 5.0;

/// Examines a recording of at least two samples.
pub(super) fn examine(recording: &Recording, lines: &LineMap, findings: &mut Vec<Finding>) {
    sampling(recording, recording.rate_hz(), lines, findings);
    readings(recording, "", lines, findings);
}

/// Looks for axes that are not connected or clipped. `of` goes before the word axis, as in `gyroscope axis x`.
pub(super) fn readings(recording: &Recording, of: &str, lines: &LineMap, findings: &mut Vec<Finding>) {
    for &axis in recording.active_axes() {
        if let Some(value) = recording.constant(axis) {
            let message =
                format!("{of}axis {axis} never changes: {} throughout; is it connected?", short(value));
            findings.push(Finding::new(FindingKind::ConstantAxis, None, message));
        }
    }
    for (one, other) in [(Axis::X, Axis::Y), (Axis::X, Axis::Z), (Axis::Y, Axis::Z)] {
        let is_same = |reading: &Vector3<f64>| reading[one.index()] == reading[other.index()];
        let is_connected = recording.constant(one).is_none();
        if recording.axes == 3 && recording.readings.iter().all(is_same) && is_connected {
            let message = format!(
                "{of}axes {one} and {other} are the same in every sample: is one column there twice?"
            );
            findings.push(Finding::new(FindingKind::EqualAxes, None, message));
        }
    }
    for found in recording.saturations() {
        let message = format!(
            "{of}axis {} may be saturated: {} samples in a row at its {} value {} {}",
            found.axis,
            found.samples,
            if found.is_largest { "largest" } else { "smallest" },
            short(found.value),
            recording.unit.symbol()
        );
        findings.push(Finding::new(FindingKind::Saturation, lines.line(found.first), message));
    }
}

/// Asks for the unit of the times where the rate is lower than that of any IMU.
pub(super) fn clock(rate: f64, findings: &mut Vec<Finding>) {
    if rate < SLOW_HZ
        && let Some((unit, short_unit)) =
            [(1e3, "ms"), (1e6, "µs"), (1e9, "ns")].into_iter().find(|(per_s, _)| per_s * rate >= USUAL_HZ)
    {
        let message = format!(
            "the samples are {} s apart: are the times in {short_unit}? at {} Hz the name of their column ends in _{}",
            short(1.0 / rate),
            short(unit * rate),
            short_unit.replace('µ', "u")
        );
        findings.push(Finding::new(FindingKind::DoubtfulClock, None, message));
    }
}

/// Looks for gaps and irregular sampling; `rate` is that of most samples, Hz.
pub(super) fn sampling(recording: &Recording, rate: f64, lines: &LineMap, findings: &mut Vec<Finding>) {
    let usual = 1.0 / rate;
    let (mut gaps, mut longest, mut least, mut most) = (0_usize, (0.0, 0), f64::INFINITY, 0.0_f64);
    for (before, pair) in recording.times_s.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if step > GAP * usual {
            gaps += 1;
            if step > longest.0 {
                longest = (step, before);
            }
            if gaps <= GAPS_SHOWN {
                let message = format!(
                    "gap of {} s after t = {} s, about {:.0} samples",
                    short(step),
                    moment(pair[0]),
                    (step / usual).round() - 1.0
                );
                findings.push(Finding::new(FindingKind::Gap, lines.line(before + 1), message));
            }
        } else {
            least = lesser(least, step);
            most = greater(most, step);
        }
    }
    if gaps > GAPS_SHOWN {
        let (step, before) = longest;
        let message = format!(
            "and {}; the longest is {} s after t = {} s",
            count(gaps - GAPS_SHOWN, "more gap"),
            short(step),
            moment(recording.times_s[before])
        );
        findings.push(Finding::new(FindingKind::Gap, lines.line(before + 1), message));
    }
    // rounding of large time stamps is no jitter
    let ends = [recording.times_s.first(), recording.times_s.last()];
    let resolution =
        4.0 * f64::EPSILON * ends.into_iter().flatten().fold(0.0_f64, |most, t| most.max(t.abs()));
    if most - usual > JITTER * usual + resolution || usual - least > JITTER * usual + resolution {
        let missing = missing(&recording.times_s, rate, GAP * usual);
        let message = format!(
            "sampling is irregular: time steps from {} to {} ms, usually {} ms ({} Hz){}",
            short(least * 1e3),
            short(most * 1e3),
            short(usual * 1e3),
            short(rate),
            if missing > 0.0 {
                format!("; {:.1} % of the samples are missing", 100.0 * missing)
            } else {
                String::new()
            }
        );
        findings.push(Finding::new(FindingKind::IrregularSampling, None, message));
    }
}
