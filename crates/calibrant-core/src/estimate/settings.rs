//! How to calibrate.

/// Settings of a calibration. The defaults serve every problem known to us.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationSettings {
    /// Iterations at most; three to six are usual.
    pub max_iterations: usize,
    /// The iteration ends when a full step is shorter than this, in standard deviations of the estimate.
    pub tolerance: f64,
    /// Is the datasheet's spread used as a prior on the parameters?
    pub datasheet_prior: bool,
}

impl Default for CalibrationSettings {
    fn default() -> Self {
        Self { max_iterations: 50, tolerance: 1e-7, datasheet_prior: false }
    }
}
