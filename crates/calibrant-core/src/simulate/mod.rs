//! Simulation of sensors and recordings from the datasheet, seeded and reproducible.
//!
//! Every item of work (a sensor, a motion) has a ChaCha stream of its own under the common seed. So results
//! do not depend on the number of threads or on the order in which items are made.

mod clock;
mod drawn_imu;
mod holds;
mod imu;
mod imu_setup;
mod initial_motion;
mod power_law_noise;
mod recording;
mod table_recording;

pub use crate::motion::sample_times;
pub use clock::{ClockedTimes, TrueClock};
pub use drawn_imu::{GyroscopeToDraw, MATRIX_SD, draw_imu, draw_known, draw_sensor, draw_thermal};
pub use holds::{HoldsSimulation, simulate_holds, simulate_holds_in};
pub use imu::simulate_imu;
pub use imu_setup::{ImuSimulation, TURN_S};
pub use initial_motion::initial_motion;
pub use power_law_noise::simulate_noise;
use rand::SeedableRng;
pub use rand_chacha::ChaCha8Rng as Rng;
pub use recording::{TrueGravity, draw_gravity, normal, perturb, simulate_recording};
pub use table_recording::{TableAction, TableStep, simulate_table};

/// The purpose of a random stream. Streams of different purposes never overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The initial motion.
    Motion,
    /// Parameters of a sensor, and process noise, poses and measurement noise of its first recording.
    Sensor,
    /// Process noise, poses and measurement noise of another recording of that sensor.
    Recording,
    /// A start of the search for the best motion.
    Start,
}

/// The random stream of item `index` for a purpose, under a seed.
#[must_use]
pub fn stream(seed: u64, purpose: Purpose, index: u64) -> Rng {
    let mut rng = Rng::seed_from_u64(seed);
    rng.set_stream(match purpose {
        Purpose::Motion => 2 * index,
        Purpose::Sensor => 2 * index + 1,
        Purpose::Recording => (1 << 63) + index,
        Purpose::Start => u64::MAX - index,
    });
    rng
}
