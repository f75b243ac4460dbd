//! The degree of a spline.

/// Degree of a spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// Piecewise constant third derivative.
    Cubic,
    /// Continuous fourth derivative.
    Quintic,
}

impl Degree {
    /// The number.
    #[must_use]
    pub fn number(self) -> usize {
        match self {
            Self::Cubic => 3,
            Self::Quintic => 5,
        }
    }

    /// Number of control points that an interval depends on.
    #[must_use]
    pub fn order(self) -> usize {
        self.number() + 1
    }
}
