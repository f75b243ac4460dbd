//! What is chosen of a simulation beside the experiment.

use crate::session::MotionSource;
use calibrant_core::budget::Budget;
use nalgebra::Vector3;

/// What is chosen of a simulation beside the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationOptions {
    /// Seed of all random numbers; `None`: that of the experiment.
    pub seed: Option<u64>,
    /// Number of the recording, from 1. Each has its own noise, and its own random poses or motion.
    pub recording: u64,
    /// The commanded motion, or the log of a machine; `None`: a random one.
    pub motion: Option<MotionSource>,
    /// Directions of the specific force in the holds of a sensor that is held by hand, at least one; `None`: random ones.
    pub poses: Option<Vec<Vector3<f64>>>,
    /// What the simulation may take.
    pub budget: Budget,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self { seed: None, recording: 1, motion: None, poses: None, budget: Budget::USUAL }
    }
}
