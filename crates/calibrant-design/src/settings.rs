//! The settings of a design: number of starts, seed, certificate, iterations, interruption.

use super::{DesignProblem, Interruption, SoFar};
use calibrant_core::error::{Error, InputError, Refusal, Result};

/// The settings of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// Largest number of starts for each axis. The search ends earlier once ten end at the same best value. A
    /// short motion of a single axis gets three for each, since they cost little.
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

/// Starts of a motion of a single axis and few nodes for each one that is asked for, and the most nodes. They
/// cost little, and a full sensor takes as many for the optima of its axes.
const SINGLE: (usize, usize) = (3, 50);

impl DesignSettings {
    /// Largest number of starts of the whole search.
    #[must_use]
    pub fn most_starts(&self, problem: &DesignProblem<'_>) -> usize {
        problem.parts().iter().map(|axes| self.starts_of(axes.len(), problem.intervals + 1)).sum()
    }

    /// Largest number of starts of one problem of so many axes and nodes.
    pub(crate) fn starts_of(&self, axes: usize, nodes: usize) -> usize {
        let each = if axes == 1 && nodes <= SINGLE.1 { SINGLE.0 } else { 1 };
        self.starts * axes * each
    }

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
