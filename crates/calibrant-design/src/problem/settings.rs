//! The settings of a design: number of starts, seed, certificate, iterations, interruption.

use crate::{Interruption, SoFar};
use calibrant_core::error::{Error, InputError, Refusal, Result};

/// The settings of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// Largest number of starts for each axis. The search ends earlier once ten end at the same best value.
    pub starts: usize,
    /// Time for the search, s, in place of a number of starts. The result then depends on the machine. A start that is
    /// under way ends with it; the certificate does not.
    pub seconds: Option<f64>,
    /// Seed of the random starts and of the initial motion.
    pub seed: u64,
    /// Is a lower bound wanted that no admissible motion can beat?
    pub certificate: bool,
    /// Gap to the lower bound at which the search ends: relative, for criterion D in nats. The bound is then
    /// found first. Without a certificate it has no effect.
    pub gap: Option<f64>,
    /// Largest number of iterations of one start.
    pub max_iterations: usize,
    /// Ends the search early where it is asked: the design is then the best so far.
    pub interruption: Interruption,
    /// What the search knows so far, for whoever waits.
    pub so_far: SoFar,
}

impl Default for DesignSettings {
    fn default() -> Self {
        Self {
            starts: 30,
            seconds: None,
            seed: 1,
            certificate: true,
            gap: None,
            max_iterations: 300,
            interruption: Interruption::default(),
            so_far: SoFar::default(),
        }
    }
}

impl DesignSettings {
    pub(crate) fn check(&self) -> Result<()> {
        match self.gap {
            Some(gap) if !(gap.is_finite() && gap > 0.0) => Err(Error::experiment(InputError::new(
                Refusal::ValueInvalid,
                format!("a search cannot end at a gap of {gap}"),
                "ask for a gap above 0, such as 0.01",
            ))),
            _ => Ok(()),
        }
    }
}
