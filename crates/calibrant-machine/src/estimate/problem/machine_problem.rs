//! What is to be calibrated on a machine.

use crate::chain::KinematicChain;
use crate::estimate::MachineSetup;
use crate::log::ReferenceLog;
use calibrant_core::interruption::Interruption;
use calibrant_core::progress::Progress;
use calibrant_core::sensor::{ImuParameters, ImuQuantity, ImuRecording};

/// A recording of an IMU on a machine, and the log of the machine's motion.
#[derive(Debug, Clone, Copy)]
pub struct MachineProblem<'a> {
    /// The sensor's samples: accelerometer, gyroscope, or both.
    pub recording: &'a ImuRecording,
    /// The log. The columns of a log of joints are in the order of the chain's joints.
    pub log: &'a ReferenceLog,
    /// The chain, for a log of joints.
    pub chain: Option<&'a KinematicChain>,
    /// What is known of machine and mount.
    pub setup: &'a MachineSetup,
    /// The sensor as its datasheet describes it: where the iteration begins.
    pub nominal: &'a ImuParameters,
    /// The sensor's parameters that are estimated.
    pub quantities: &'a [ImuQuantity],
}

/// How to solve it. The defaults serve every problem known to us.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineSettings {
    /// Gauss–Newton steps at most, once the noise is known.
    pub max_iterations: usize,
    /// The iteration ends when a step is shorter than this, in standard deviations of the parameters.
    pub tolerance: f64,
    /// Rounds of the search for the noise at most.
    pub max_noise_rounds: usize,
    /// Ends the calibration without a result.
    pub interruption: Interruption,
    /// Is told of each round and each step.
    pub progress: Progress,
}

impl Default for MachineSettings {
    fn default() -> Self {
        Self {
            max_iterations: 30,
            tolerance: 1e-2,
            max_noise_rounds: 25,
            interruption: Interruption::default(),
            progress: Progress::default(),
        }
    }
}
