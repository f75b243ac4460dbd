//! Where everything random of a simulation comes from.

use calibrant::simulate::{Purpose, Rng, stream};

/// Where everything random comes from.
#[derive(Clone, Copy)]
pub(super) struct Random {
    pub(super) seed: u64,
    /// From 1.
    pub(super) recording: u64,
}

impl Random {
    pub(super) fn sensor(self) -> Rng {
        stream(self.seed, Purpose::Sensor, 0)
    }

    /// Of what happens in the recording, all of the sensor being drawn: the first goes on in the sensor's stream, so that a seed means what it always did.
    pub(super) fn happening(self, after_sensor: Rng) -> Rng {
        match self.recording {
            1 => after_sensor,
            another => stream(self.seed, Purpose::Recording, another),
        }
    }
}
