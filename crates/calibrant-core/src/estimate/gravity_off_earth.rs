//! A given gravity that occurs nowhere on the Earth.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::GravityOffEarth;
use crate::motion::Gravity;

/// The warning about such a gravity. No recording contradicts it, since all gains are wrong by the same ratio.
pub(super) fn gravity_off_earth(gravity: &Gravity) -> Option<Diagnostic> {
    let [least_mps2, most_mps2] = gravity.elsewhere()?;
    Some(Diagnostic::from(GravityOffEarth { gravity_mps2: gravity.magnitude_mps2, least_mps2, most_mps2 }))
}
