//! The quality of a recording as a whole: gaps, irregular sampling, axes that are not connected, clipped
//! readings.

use super::glued_axes::glued_axes;
use super::line_map::LineMap;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{
    AxisStuck, ClockDoubtful, ReadingsClipped, SamplingGap, SamplingIrregular,
};
use calibrant_core::sensor::{Recording, SensorKind, greater, lesser, missing};

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

/// Looks for axes that are not connected or clipped. `sensor_kind` is given where there are two sensors.
pub(crate) fn readings(
    recording: &Recording,
    sensor_kind: Option<SensorKind>,
    lines: &LineMap,
    findings: &mut Vec<Diagnostic>,
) {
    for &axis in recording.active_axes() {
        if let Some(value) = recording.constant(axis) {
            findings.push(Diagnostic::from(AxisStuck { axis, value, times: None }).about(sensor_kind));
        }
    }
    let glued = glued_axes(recording).into_iter();
    findings.extend(glued.map(|(found, first)| found.about(sensor_kind).at_line(lines.line(first))));
    for found in recording.saturations() {
        let clipped = ReadingsClipped {
            axis: found.axis,
            samples: found.samples,
            is_largest: found.is_largest,
            value: found.value,
            unit: recording.unit(),
        };
        findings.push(Diagnostic::from(clipped).about(sensor_kind).at_line(lines.line(found.first)));
    }
}

/// Asks for the unit of the times where the rate is lower than that of any IMU.
pub(crate) fn clock(rate: f64, findings: &mut Vec<Diagnostic>) {
    if rate < SLOW_HZ
        && let Some((per_s, unit)) =
            [(1e3, "ms"), (1e6, "µs"), (1e9, "ns")].into_iter().find(|(per_s, _)| per_s * rate >= USUAL_HZ)
    {
        findings.push(ClockDoubtful { step_s: 1.0 / rate, unit, rate_hz: per_s * rate }.into());
    }
}

/// Looks for gaps and irregular sampling; `rate` is that of most samples, Hz.
pub(crate) fn sampling(times_s: &[f64], rate: f64, lines: &LineMap, findings: &mut Vec<Diagnostic>) {
    let usual = 1.0 / rate;
    let (mut gaps, mut longest, mut least, mut most) = (0_usize, (0.0, 0), f64::INFINITY, 0.0_f64);
    for (before, pair) in times_s.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if step > GAP * usual {
            gaps += 1;
            if step > longest.0 {
                longest = (step, before);
            }
            if gaps <= GAPS_SHOWN {
                let samples = (step / usual).round() - 1.0;
                let gap = SamplingGap { length_s: step, after_s: pair[0], samples, more: None };
                findings.push(Diagnostic::from(gap).at_line(lines.line(before + 1)));
            }
        } else {
            least = lesser(least, step);
            most = greater(most, step);
        }
    }
    if gaps > GAPS_SHOWN {
        let (length_s, before) = longest;
        let gap = SamplingGap {
            length_s,
            after_s: times_s[before],
            samples: (length_s / usual).round() - 1.0,
            more: Some(gaps - GAPS_SHOWN),
        };
        findings.push(Diagnostic::from(gap).at_line(lines.line(before + 1)));
    }
    // rounding of large time stamps is no jitter
    let ends = [times_s.first(), times_s.last()];
    let resolution =
        4.0 * f64::EPSILON * ends.into_iter().flatten().fold(0.0_f64, |most, t| most.max(t.abs()));
    if most - usual > JITTER * usual + resolution || usual - least > JITTER * usual + resolution {
        let missing_share = missing(times_s, rate, GAP * usual);
        findings
            .push(SamplingIrregular { least_s: least, most_s: most, rate_hz: rate, missing_share }.into());
    }
}
