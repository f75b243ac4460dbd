//! The random streams of a simulation.

use calibrant_core::motion::Gravity;
use calibrant_core::simulate::{Purpose, Rng, draw_magnitude, stream};

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

    /// The magnitude of gravity where the sensor is, as uncertain as it is known, m/s². All recordings are of one place.
    pub(super) fn gravity_mps2(self, known: &Gravity) -> f64 {
        draw_magnitude(known, &mut stream(self.seed, Purpose::Place, 0))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_scatters_as_it_is_known_and_is_that_of_one_place() {
        let at = |seed: u64, recording: u64, sd_mps2: f64| {
            Random { seed, recording }.gravity_mps2(&Gravity { magnitude_mps2: 9.8, sd_mps2 })
        };
        assert_eq!(at(1, 1, 0.0), 9.8);
        assert_eq!(at(1, 1, 0.02), at(1, 2, 0.02));
        let count = 400;
        let squares: f64 = (0..count).map(|seed| ((at(seed, 1, 0.02) - 9.8) / 0.02).powi(2)).sum();
        // four standard deviations of a standard deviation
        let sd = (squares / count as f64).sqrt();
        assert!((sd - 1.0).abs() < 4.0 / (2.0 * count as f64).sqrt(), "{sd}");
    }
}
