//! What the design of poses takes, estimated before it begins.

use super::fewest::MOST;
use super::search::BEGINNING;
use super::{Allowed, PoseProblem, exchange};
use crate::DesignSettings;
use calibrant_core::budget::Budget;

impl DesignSettings {
    /// What the design of these poses takes.
    #[must_use]
    pub fn work_on_poses(&self, problem: &PoseProblem) -> Budget {
        let directions = match &problem.allowed {
            Allowed::Of(list) => list.len(),
            _ => BEGINNING,
        };
        let pairs = match &problem.allowed {
            Allowed::Of(list) => exchange::pairs(problem.poses, list.len()) as f64,
            _ => 0.0,
        };
        let (starts, poses, directions) = (self.starts as f64, problem.poses as f64, directions as f64);
        // measured, within a factor of two: the exchange of each pose for each direction, of pairs twice or so, and their order
        let seconds = starts * (25e-6 * poses * directions + 2e-5 * pairs) + 1.5e-7 * poses.powf(3.5);
        Budget { bytes: 1e3 * starts * poses + 1e4 * directions, seconds }
    }

    /// What the search for the fewest poses takes at most: some designs, the last of them of the most poses.
    #[must_use]
    pub fn work_on_fewest_poses(&self, problem: &PoseProblem) -> Budget {
        /// Designs that are as long as the last.
        const DESIGNS: f64 = 4.0;
        self.work_on_poses(&PoseProblem { poses: MOST, ..problem.clone() }).repeated(DESIGNS)
    }
}
