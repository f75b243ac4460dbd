//! The remark on limits that count from rest, where the experiment does not say where the arm is at rest.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::design::RestAssumed;
use calibrant_core::motion::{Limits, Rest};

/// Says that the motion starts at rest, where limits imply it and `rest` is not set.
#[must_use]
pub fn remark(limits: &Limits) -> Option<Diagnostic> {
    counts_from_rest(limits).map(|limit| RestAssumed { limit }.into())
}

/// The first limit that counts from rest, where `rest` is not set.
fn counts_from_rest(limits: &Limits) -> Option<&'static str> {
    if limits.rest != Rest::None {
        return None;
    }
    let velocity = limits.velocity_mps.map(|_| "velocity");
    velocity.or_else(|| limits.displacement_m.map(|_| "displacement"))
}
