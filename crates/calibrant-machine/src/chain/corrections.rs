//! How a machine differs from its file.

use nalgebra::Vector3;

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
