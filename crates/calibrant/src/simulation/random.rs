//! The random streams of a simulation.

use calibrant_core::simulate::{Purpose, Rng, stream};

/// The source of everything random.
#[derive(Clone, Copy)]
pub(super) struct Random {
    pub(super) seed: u64,
    /// Number of the recording, from 1.
    pub(super) recording: u64,
}

impl Random {
    pub(super) fn sensor(self) -> Rng {
        stream(self.seed, Purpose::Sensor, 0)
    }

    /// The stream of what happens in the recording, after the sensor has been drawn. The first recording
    /// continues the sensor's stream, so that a seed keeps its meaning.
    pub(super) fn happening(self, after_sensor: Rng) -> Rng {
        match self.recording {
            1 => after_sensor,
            another => stream(self.seed, Purpose::Recording, another),
        }
    }
}
