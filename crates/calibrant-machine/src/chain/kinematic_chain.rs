//! Joints one after the other.

use super::{ChainCorrections, CorrectedChain, Joint};
use nalgebra::Isometry3;

/// The joints that move between a base and a tip. Fixed joints are part of the transform of the next joint, or of the tip.
///
/// # Examples
/// A rate table turns at 2 rad/s. A frame 0.5 m from its axis feels gravity, and 2 m/s² towards the axis.
/// ```
/// use calibrant_machine::chain::*;
/// use nalgebra::{Isometry3, Vector3};
/// let table = KinematicChain {
///     base: "base".into(),
///     tip: "plate".into(),
///     joints: vec![Joint {
///         name: "table".into(),
///         kind: JointKind::Continuous,
///         axis: Vector3::z_axis(),
///         origin: Isometry3::identity(),
///         limits: JointLimits::default(),
///     }],
///     tip_transform: Isometry3::translation(0.5, 0.0, 0.0),
/// };
/// let state = JointState { positions: &[0.3], velocities: &[2.0], accelerations: &[0.0] };
/// let base = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.8));
/// let tip = table.nominal().tip_motion(state, &base);
/// assert!((tip.specific_force - Vector3::new(-2.0, 0.0, 9.8)).norm() < 1e-12);
/// assert_eq!(tip.rate, Vector3::new(0.0, 0.0, 2.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct KinematicChain {
    /// Name of the link that does not move.
    pub base: String,
    /// Name of the link that carries the sensor.
    pub tip: String,
    /// The joints that move, from base to tip.
    pub joints: Vec<Joint>,
    /// Pose of the tip in the frame of the last joint, or in the base if no joint moves; m.
    pub tip_transform: Isometry3<f64>,
}

impl KinematicChain {
    /// The chain as its file says.
    #[must_use]
    pub fn nominal(&self) -> CorrectedChain {
        self.corrected(&ChainCorrections::none(self.joints.len()))
    }

    /// The chain with corrections of its geometry.
    ///
    /// # Panics
    /// If the corrections are for another number of joints.
    #[must_use]
    pub fn corrected(&self, corrections: &ChainCorrections) -> CorrectedChain {
        CorrectedChain::new(&self.joints, &self.tip_transform, corrections)
    }
}
