//! Sentences about spikes and invalid samples of a recording.

use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind, Spikes};

/// How many samples of a sensor were replaced or removed, in words.
#[must_use]
pub fn spikes_taken_out(found: &Spikes, sensor_kind: SensorKind, unit: ReadingUnit) -> String {
    let counts = (found.samples.len(), found.cut.len());
    spikes(sensor_kind, unit, counts, found.axis, (found.reading, found.time_s, found.deviations))
}

/// `counts`: samples that were replaced, and samples that were removed.
/// The last argument is the sample farthest from its neighbours: reading, time in s, and distance in standard deviations of the noise.
pub(super) fn spikes(
    sensor_kind: SensorKind,
    unit: ReadingUnit,
    counts: (usize, usize),
    axis: Axis,
    (reading, time_s, deviations): (f64, f64, f64),
) -> String {
    let counted = |count: usize| if count == 1 { "1 sample".into() } else { format!("{count} samples") };
    let what = match counts {
        (0, cut) => invalid(cut, &counted(cut)),
        (spikes, 0) => replaced(spikes, &counted(spikes)),
        (spikes, cut) => {
            format!("{}; {}", replaced(spikes, &counted(spikes)), invalid(cut, &format!("{cut} more")))
        }
    };
    let off = if deviations.is_finite() {
        let few = deviations < 1e4;
        let times = if few { format!("{deviations:.0}") } else { format!("{deviations:.1e}") };
        format!(", {times} standard deviations of the noise from its neighbours")
    } else {
        String::new()
    };
    // ten digits, as the largest integer of 32 bits has
    let reading: f64 = format!("{reading:.9e}").parse().unwrap_or(reading);
    format!(
        "{sensor_kind}: {what}. The farthest reads {reading:?} {} at {time_s:.3} s on axis {axis}{off}. Look for a loose contact, or for bytes lost on the way.",
        unit.symbol()
    )
}

fn invalid(count: usize, counted: &str) -> String {
    let (are, were) = if count == 1 { ("is", "was") } else { ("are", "were") };
    format!("{counted} {are} invalid and {were} removed")
}

fn replaced(count: usize, counted: &str) -> String {
    let (are, were) = if count == 1 { ("is a spike", "was") } else { ("are spikes", "were") };
    format!("{counted} {are} and {were} replaced by the line between the neighbours")
}
