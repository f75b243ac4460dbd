//! What a joint may do.

use calibrant_machine::chain::SpeedNearEnds;

/// Limits of one joint, rad or m and seconds. An infinite one is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLimit {
    /// Smallest position.
    pub lower: f64,
    /// Largest position.
    pub upper: f64,
    /// Largest speed.
    pub velocity: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest jerk.
    pub jerk: f64,
    /// Speed that falls towards the ends of the joint, as Franka's arms have it.
    pub near_ends: Option<SpeedNearEnds>,
}
