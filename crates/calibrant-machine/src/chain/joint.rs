//! A joint that moves, and what a calibration adds to the chain's nominal dimensions.

use nalgebra::{Isometry3, Unit, Vector3};

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about its axis, between limits; rad.
    Revolute,
    /// Turns about its axis without limits; rad.
    Continuous,
    /// Moves along its axis, between limits; m.
    Prismatic,
}

impl JointKind {
    /// The name in a URDF file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Continuous => "continuous",
            Self::Prismatic => "prismatic",
        }
    }

    /// Whether the joint turns.
    #[must_use]
    pub fn turns(self) -> bool {
        self != Self::Prismatic
    }

    /// Unit of its position.
    #[must_use]
    pub fn unit(self) -> &'static str {
        if self.turns() { "rad" } else { "m" }
    }
}

/// What a joint may do, as far as it is known. Positions are in rad or m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointLimits {
    /// Smallest position.
    pub lower: Option<f64>,
    /// Largest position.
    pub upper: Option<f64>,
    /// Largest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// Largest torque or force, N·m or N.
    pub effort: Option<f64>,
    /// A speed that falls towards its ends.
    pub near_ends: Option<SpeedNearEnds>,
}

/// A speed that falls towards the ends of a joint, so that it can stop there, as Franka's arms have it:
///
/// `−√(k (q − lower)) + o ≤ q̇ ≤ √(k (upper − q)) − o`. Where the right side is negative or the left one positive, the joint may not move that way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedNearEnds {
    /// `lower`, rad or m.
    pub lower: f64,
    /// `upper`, rad or m.
    pub upper: f64,
    /// `k`, twice the deceleration, rad/s² or m/s².
    pub slope: f64,
    /// `o`, rad/s or m/s.
    pub offset: f64,
}

impl SpeedNearEnds {
    /// `k (upper − q) − max(q̇ + o, 0)²`, and the same at the other end: not negative where the limit is kept. Towards an end it is that limit; away from it, it is weaker.
    /// With its derivatives by `q` and `q̇`.
    #[must_use]
    pub fn rooms(&self, q: f64, qd: f64) -> [[f64; 3]; 2] {
        let [up, down] = [(qd + self.offset).max(0.0), (self.offset - qd).max(0.0)];
        [
            [self.slope * (self.upper - q) - up * up, -self.slope, -2.0 * up],
            [self.slope * (q - self.lower) - down * down, self.slope, 2.0 * down],
        ]
    }
}

/// A joint that moves, and the fixed transform before it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The name.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Its axis, in its own frame.
    pub axis: Unit<Vector3<f64>>,
    /// Pose of its frame at position 0 in the frame of the joint before, or in the base; m.
    pub origin: Isometry3<f64>,
    /// Its limits.
    pub limits: JointLimits,
}

/// What differs at one joint: its transform is `origin · (exp(rotation), translation) · joint(q + zero)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointCorrection {
    /// Translation of the joint, in its frame of the file, m.
    pub translation_m: Vector3<f64>,
    /// Rotation vector of the joint, in its frame of the file, rad.
    pub rotation_rad: Vector3<f64>,
    /// Position of the joint where its encoder reads 0, rad or m.
    pub zero: f64,
}

/// What differs at each joint.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainCorrections {
    /// One for each joint that moves.
    pub joints: Vec<JointCorrection>,
}

impl ChainCorrections {
    /// Number of geometry parameters of a joint: three translations, then three rotations.
    pub const GEOMETRY_PER_JOINT: usize = 6;

    /// No corrections.
    #[must_use]
    pub fn none(joints: usize) -> Self {
        Self { joints: vec![JointCorrection::default(); joints] }
    }
}
