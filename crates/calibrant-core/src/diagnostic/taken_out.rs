//! The diagnostic of spikes and invalid samples.

use crate::diagnostic::value::Diagnostic;
use crate::sensor::{ReadingUnit, SensorKind, Spikes};

impl Diagnostic {
    /// The diagnostic of a sensor's spikes. `unit`: that of its readings.
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
