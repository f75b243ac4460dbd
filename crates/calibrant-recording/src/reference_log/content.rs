//! What the rows of a log hold.

use super::pose_columns::VALUES;

/// What the values of a row are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    /// A position for each joint, then a velocity for each and an acceleration for each, where there are any; `derivatives` says up to which.
    /// `turns`: is the unit of each that of an angle? `None` where nothing says it.
    Joints { names: Vec<String>, turns: Vec<Option<bool>>, has_velocities: bool, derivatives: usize },
    /// x, y, z, then w, x, y, z of the quaternion.
    Poses,
}

impl Content {
    /// Number of values of a row.
    pub(super) fn width(&self) -> usize {
        match self {
            Self::Joints { names, derivatives, .. } => (1 + derivatives) * names.len(),
            Self::Poses => VALUES,
        }
    }
}
