//! What a joint may do.

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

/// A speed that falls towards the ends of a joint:
///
/// `−√(k (q − lower)) + o ≤ q̇ ≤ √(k (upper − q)) − o`, where the right is positive and the left negative; otherwise the joint may not move that way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedNearEnds {
    /// `lower`.
    pub lower: f64,
    /// `upper`.
    pub upper: f64,
    /// `k`, rad/s² or m/s².
    pub slope: f64,
    /// `o`, rad/s or m/s.
    pub offset: f64,
}

impl SpeedNearEnds {
    /// `k (upper − q) − max(q̇ + o, 0)²`, and the same at the other end: not negative where the limit is kept. Towards an end it is that limit; away from it, it is weaker.
    /// With its derivatives by `q` and `q̇`.
    pub(crate) fn rooms(&self, q: f64, qd: f64) -> [[f64; 3]; 2] {
        let [up, down] = [(qd + self.offset).max(0.0), (self.offset - qd).max(0.0)];
        [
            [self.slope * (self.upper - q) - up * up, -self.slope, -2.0 * up],
            [self.slope * (q - self.lower) - down * down, self.slope, 2.0 * down],
        ]
    }
}
