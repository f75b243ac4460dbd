//! Initial values: the accelerometer from unknown directions or known faces, its temperature terms, and the gyroscope's bias.

pub(crate) mod accelerometer;
pub(crate) mod accelerometer_alone;
pub(crate) mod face_alignment;
pub(crate) mod face_repeats;
pub(crate) mod face_statistics;
pub(crate) mod gyroscope;
pub(crate) mod known_faces;
pub(crate) mod temperature_terms;
pub(crate) mod unknown_directions;
