//! What the rows of a log hold.

use super::orientation_form::OrientationForm;
use calibrant_core::diagnostic::Diagnostic;

/// What the values of a row are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    /// A position for each joint, then a velocity for each and an acceleration for each, where there are any; `derivatives` says up to which.
    /// `turns`: is the unit of each that of an angle? `None` where nothing says it.
    Joints { names: Vec<String>, turns: Vec<Option<bool>>, has_velocities: bool, derivatives: usize },
    /// x, y, z, then the values of this form of an orientation.
    Poses(OrientationForm),
}

impl Content {
    /// Number of values of a row.
    pub(super) fn width(&self) -> usize {
        match self {
            Self::Joints { names, derivatives, .. } => (1 + derivatives) * names.len(),
            Self::Poses(form) => 3 + form.width(),
        }
    }
}

/// The values of a row: where their columns are.
pub(super) struct Values {
    pub(super) content: Content,
    /// For each column its slot: 0 is the time, values follow.
    pub(super) slots: Vec<Option<usize>>,
    /// The factor on each value.
    pub(super) factors: Vec<f64>,
    /// What was taken for granted.
    pub(super) assumed: Option<Diagnostic>,
}
