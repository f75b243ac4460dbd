//! Variance components: the scatter between holds, that of the rotations, and the Earth's rate, which are the weights of the least squares.

pub(crate) mod between_holds;
pub(crate) mod bias_drift;
pub(crate) mod iteration;
pub(crate) mod linear_problem;
pub(crate) mod rotations;
pub(crate) mod solution;
