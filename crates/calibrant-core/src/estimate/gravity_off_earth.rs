//! A gravity that the Earth has nowhere.

use crate::diagnostic::Diagnostic;
use crate::motion::Gravity;

/// What a user should know of a gravity that the Earth has nowhere. No recording contradicts it, since all gains are off by the same share.
pub(super) fn gravity_off_earth(gravity: &Gravity) -> Option<Diagnostic> {
    let [least_mps2, most_mps2] = gravity.elsewhere()?;
    Some(Diagnostic::GravityOffEarth { gravity_mps2: gravity.magnitude_mps2, least_mps2, most_mps2 })
}
