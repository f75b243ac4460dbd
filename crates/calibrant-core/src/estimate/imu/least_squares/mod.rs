//! The least squares of all: rotations integrated, and Gauss–Newton on the bordered chain.

pub(crate) mod angular_rate;
pub(crate) mod earth_rate;
pub(crate) mod gauss_newton;
pub(crate) mod integration;
mod on_faces;
pub(crate) mod sphere_logarithm;
