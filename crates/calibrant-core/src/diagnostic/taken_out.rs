//! The diagnostic of spikes that were taken out of a recording.

use crate::diagnostic::value::Diagnostic;
use crate::sensor::{ReadingUnit, SensorKind, Spikes};

impl Diagnostic {
    /// Of the spikes of a sensor whose readings are in this unit.
    #[must_use]
    pub fn spikes(spikes: &Spikes, sensor_kind: SensorKind, unit: ReadingUnit) -> Self {
        Self::Spikes {
            sensor_kind,
            unit,
            replaced: spikes.samples.len(),
            cut: spikes.cut.len(),
            axis: spikes.axis,
            reading: spikes.reading,
            time_s: spikes.time_s,
            deviations: spikes.deviations,
        }
    }
}
