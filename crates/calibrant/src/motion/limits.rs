//! The arm's limits.

use nalgebra::Vector3;

/// Where the arm is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rest {
    /// Nowhere in particular.
    #[default]
    None,
    /// At the start.
    Start,
    /// At the start and at the end.
    Both,
}

/// Symmetric limits per axis; `None` where there is none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Largest acceleration, m/s².
    pub acceleration_mps2: Option<Vector3<f64>>,
    /// Largest jerk, m/s³.
    pub jerk_mps3: Option<Vector3<f64>>,
    /// Largest intercept of an interval's line at t = 0 (the report's bound on x), m/s².
    pub intercept_mps2: Option<Vector3<f64>>,
    /// Largest velocity, m/s.
    pub velocity_mps: Option<Vector3<f64>>,
    /// Largest displacement, m.
    pub displacement_m: Option<Vector3<f64>>,
    /// Where the velocity is zero.
    pub rest: Rest,
}
