//! Blocks of time: what the data of each say of the parameters.

use nalgebra::{DMatrix, DVector};

/// What the samples of a block of time say of the parameters, the motion eliminated.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Their part of the right side.
    pub(crate) score: DVector<f64>,
    pub(crate) information: DMatrix<f64>,
}

impl Block {
    /// The block with the one behind it.
    pub(crate) fn with(mut self, next: &Self) -> Self {
        self.score += &next.score;
        self.information += &next.information;
        self
    }
}

/// Length of the blocks of a recording of this duration, s: an error of the reference may last so long.
pub(crate) fn block_s(duration_s: f64) -> f64 {
    (duration_s / 60.0).clamp(0.5, 3.0)
}
