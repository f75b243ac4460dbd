//! The positions of the joints of a machine over time.

/// A log of joint positions.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLog {
    /// Names of the joints, one for each column.
    pub names: Vec<String>,
    /// Times, s: finite, not decreasing. Repeated samples are allowed.
    pub times_s: Vec<f64>,
    /// Positions, rad or m, row by row: one row for each time. A value that was not recorded is NaN.
    pub positions: Vec<f64>,
    /// Velocities in the same order, rad/s or m/s, where the machine logs them.
    pub velocities: Option<Vec<f64>>,
}

impl JointLog {
    /// The positions at sample `k`.
    #[must_use]
    pub fn row(&self, k: usize) -> &[f64] {
        &self.positions[k * self.names.len()..][..self.names.len()]
    }
}
