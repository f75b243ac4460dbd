//! Spikes that were taken out of a recording, in words.

use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind, Spikes};

/// What was taken out of the recording of a sensor, in words.
#[must_use]
pub fn spikes_taken_out(found: &Spikes, sensor_kind: SensorKind, unit: ReadingUnit) -> String {
    let counts = (found.samples.len(), found.cut.len());
    spikes(sensor_kind, unit, counts, found.axis, (found.reading, found.time_s, found.deviations))
}

/// `counts`: of samples that were replaced, and cut out. `farthest`: reading, time in s and deviations of the one that is farthest off.
pub(super) fn spikes(
    sensor_kind: SensorKind,
    unit: ReadingUnit,
    counts: (usize, usize),
    axis: Axis,
    (reading, time_s, deviations): (f64, f64, f64),
) -> String {
    let counted = |count: usize| if count == 1 { "1 sample".into() } else { format!("{count} samples") };
    let what = match counts {
        (0, 1) => "1 sample cannot be a reading and was cut out".to_owned(),
        (0, cut) => format!("{} cannot be readings and were cut out", counted(cut)),
        (spikes, 0) => replaced(spikes, &counted(spikes)),
        (spikes, cut) => {
            format!(
                "{}; {} more cannot be readings and were cut out",
                replaced(spikes, &counted(spikes)),
                counted(cut)
            )
        }
    };
    let off = if deviations.is_finite() {
        let few = deviations < 1e4;
        let times = if few { format!("{deviations:.0}") } else { format!("{deviations:.1e}") };
        format!(", {times} standard deviations of the noise off")
    } else {
        String::new()
    };
    // as many digits as the largest of 32 bits
    let reading: f64 = format!("{reading:.9e}").parse().unwrap_or(reading);
    format!(
        "{sensor_kind}: {what}; farthest off is {reading:?} {} at {time_s:.3} s on axis {axis}{off}: a loose contact, or a byte lost on the way?",
        unit.symbol()
    )
}

fn replaced(count: usize, counted: &str) -> String {
    match count {
        1 => format!("{counted} far off those beside it was left out, the line between them in its place"),
        _ => format!(
            "{counted} far off those beside them were left out, the line between these in the place of each"
        ),
    }
}
