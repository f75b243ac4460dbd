//! The terms, in the order of their sums.

use crate::estimate::imu::terms::hold_force::HoldForce;
use crate::estimate::imu::terms::hold_rate::HoldRate;
use crate::estimate::imu::terms::known::Known;
use crate::estimate::imu::terms::rotation::Rotation;
use crate::estimate::imu::terms::term::{Place, Term};
use crate::estimate::imu::terms::turn::Turn;

/// All terms.
pub(crate) const TERMS: [&dyn Term; 5] = [&HoldForce, &HoldRate, &Rotation, &Turn, &Known];

/// The terms that stand there.
pub(crate) fn terms(place: Place) -> impl DoubleEndedIterator<Item = &'static dyn Term> {
    TERMS.into_iter().filter(move |term| term.place() == place)
}
