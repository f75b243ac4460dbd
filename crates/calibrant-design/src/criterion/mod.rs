//! The criteria as the search and the certificate need them: smooth, with tangents and second-order models.

pub(crate) mod criterion_model;
pub(crate) mod smooth_criterion;
pub(crate) mod tangent_bound;
