//! Why a rotation is not used.

use crate::diagnostic::parts::{Part, Parts};

/// Why a rotation is not used, as its row in the result states it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RotationReason(pub String);

impl Part for RotationReason {
    fn add_to(&self, _: &mut Parts, _: &'static str) {}
}
