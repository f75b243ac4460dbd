//! What one pass over the data uses.

use crate::estimate::MachineTrust;

/// Which samples are used, and whether the motion is unknown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pass {
    /// With noisy trust the control points are unknowns, and the log measures them.
    pub(crate) trust: MachineTrust,
    /// Samples of each sensor, about, spread evenly.
    pub(crate) samples: usize,
}

impl Pass {
    /// All samples.
    pub(crate) fn all(trust: MachineTrust) -> Self {
        Self { trust, samples: usize::MAX }
    }

    /// The motion is the smoothed log, and about this number of samples of each sensor is used.
    pub(crate) fn trusting(samples: usize) -> Self {
        Self { trust: MachineTrust::Known, samples }
    }

    /// Every how many samples of `length` are used.
    pub(crate) fn stride(self, length: usize) -> usize {
        (length / self.samples).max(1)
    }

    pub(crate) fn noisy(self) -> bool {
        self.trust == MachineTrust::Noisy
    }
}
