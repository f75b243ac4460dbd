//! The settings of a design: number of starts, seed, certificate, iterations, interruption.

use super::Interruption;

/// The settings of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// Largest number of starts for each axis. The search ends earlier once ten end at the same best value.
    pub starts: usize,
    /// Time for the search, s, in place of a number of starts. The result then depends on the machine.
    pub seconds: Option<f64>,
    /// Seed of the random starts and of the initial motion.
    pub seed: u64,
    /// Is a lower bound wanted that no admissible motion can beat?
    pub certificate: bool,
    /// Largest number of iterations of one start.
    pub max_iterations: usize,
    /// Ends the search early where it is asked: the design is then the best so far.
    pub interruption: Interruption,
}

impl Default for DesignSettings {
    fn default() -> Self {
        Self {
            starts: 30,
            seconds: None,
            seed: 1,
            certificate: true,
            max_iterations: 300,
            interruption: Interruption::default(),
        }
    }
}
