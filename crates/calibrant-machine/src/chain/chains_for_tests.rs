//! Chains for the tests.

use super::{ChainCorrections, Joint, JointCorrection, JointKind, JointLimits, KinematicChain};
use nalgebra::{Isometry3, Unit, Vector3};

/// Numbers without a pattern (splitmix64).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// A number from `-size` to `size`.
    pub(crate) fn next(&mut self, size: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        size * (2.0 * ((z ^ (z >> 31)) as f64 / u64::MAX as f64) - 1.0)
    }

    /// A vector with such components.
    pub(crate) fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next(size))
    }

    fn pose(&mut self) -> Isometry3<f64> {
        Isometry3::new(self.vector(0.5), self.vector(2.0))
    }
}

/// A chain of joints of all kinds, with axes and transforms in all directions.
pub(crate) fn mixed_chain(joints: usize, numbers: &mut Numbers) -> KinematicChain {
    let kinds = [JointKind::Revolute, JointKind::Prismatic, JointKind::Continuous];
    let joint = |i: usize, numbers: &mut Numbers| Joint {
        name: format!("joint_{i}"),
        kind: kinds[(i + numbers.0 as usize % 3) % 3],
        axis: Unit::new_normalize(numbers.vector(1.0)),
        origin: numbers.pose(),
        limits: JointLimits::default(),
    };
    let joints = (0..joints).map(|i| joint(i, numbers)).collect();
    KinematicChain { base: "base".into(), tip: "tip".into(), joints, tip_transform: numbers.pose() }
}

/// Corrections of this size.
pub(crate) fn corrections_of(joints: usize, size: f64, numbers: &mut Numbers) -> ChainCorrections {
    let one = |_| JointCorrection {
        translation_m: numbers.vector(size),
        rotation_rad: numbers.vector(size),
        zero: numbers.next(size),
    };
    ChainCorrections { joints: (0..joints).map(one).collect() }
}
