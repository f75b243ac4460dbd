//! The remark on limits that count from rest, where the experiment does not say where the arm is at rest.

use crate::diagnostics::tell;
use calibrant::diagnostic::design::RestAssumed;
use calibrant::motion::{Limits, Rest};

/// Says that the motion starts at rest, where limits imply it and `rest` is not set.
pub(crate) fn remark(limits: &Limits) {
    if let Some(limit) = counts_from_rest(limits) {
        tell(RestAssumed { limit });
    }
}

/// The first limit that counts from rest, where `rest` is not set.
fn counts_from_rest(limits: &Limits) -> Option<&'static str> {
    if limits.rest != Rest::None {
        return None;
    }
    let velocity = limits.velocity_mps.map(|_| "velocity");
    velocity.or_else(|| limits.displacement_m.map(|_| "displacement"))
}
