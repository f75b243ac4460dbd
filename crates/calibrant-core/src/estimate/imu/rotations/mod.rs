//! The gyroscope between the stationary intervals: rotations, and turns of known angle.

pub(crate) mod felt_force;
pub(crate) mod gravity_at_ends;
pub(crate) mod knocks;
pub(crate) mod movement;
pub(crate) mod spans;
pub(crate) mod turns;
