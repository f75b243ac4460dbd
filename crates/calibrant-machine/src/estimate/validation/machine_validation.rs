//! What a validation on a machine gives.

use crate::estimate::MachineQuantity;
use calibrant_core::estimate::CovarianceVerdict;
use calibrant_core::sensor::SensorKind;
use schemars::JsonSchema;
use serde::Serialize;

/// How far the sensor's parameters move with other data, beside what their covariance predicts.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineValidation {
    /// The other data.
    pub source: MachineValidationSource,
    /// The parameters of each sensor.
    pub shifts: Vec<ParameterShift>,
}

/// The other data.
#[derive(Debug, Clone, PartialEq)]
pub enum MachineValidationSource {
    /// Another recording on the same machine.
    Recording {
        /// Its name, for people; empty until someone gives it one.
        name: String,
    },
    /// The recording without a block of time, for one block after the other.
    Blocks {
        /// Number of blocks.
        folds: usize,
        /// Length of a block, s.
        length_s: f64,
        /// Blocks without which there is no calibration.
        failed: Vec<FailedBlock>,
    },
}

/// A block of time without which there is no calibration.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FailedBlock {
    /// Its beginning on the clock of the IMU, s.
    pub start_s: f64,
    /// Its end, s.
    pub end_s: f64,
    /// What is wrong, in words.
    pub reason: String,
}

/// The movement of one sensor's parameters `Δ`, and its predicted covariance `C`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterShift {
    /// The sensor.
    pub sensor: SensorKind,
    /// `Δᵀ C⁻¹ Δ`, summed over the blocks and scaled to its degrees of freedom (`satterthwaite1946`).
    pub chi2: f64,
    /// Its degrees of freedom: combinations of parameters that the other data determine, for each block but one.
    pub degrees_of_freedom: usize,
    /// `√(χ²/degrees of freedom)`: by how much the standard deviations are too small.
    pub factor: f64,
    /// Its 99 % confidence interval.
    pub factor_interval: (f64, f64),
    /// What follows.
    pub verdict: CovarianceVerdict,
    /// The largest movement.
    pub largest: LargestShift,
}

/// The parameter that moves most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestShift {
    /// The parameter.
    pub quantity: MachineQuantity,
    /// Its movement, in the unit of the parameter.
    pub shift: f64,
    /// The same in predicted standard deviations.
    pub in_sd: f64,
    /// Beginning of the block that was left out, on the clock of the IMU, s; `None` for another recording.
    pub without_s: Option<f64>,
}
